"""Pages of the public names of mbsd, from what Python says of them: signatures and docstrings."""
