"""Rows of J that come and go during a run: of contacts and of joints that stick."""
