"""Rows of joints that repeat others: which of them hold."""
