"""The plots, a page a file."""
