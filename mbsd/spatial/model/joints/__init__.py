"""Joints in space, one kind a file, each a list of rows."""
