"""Bodies and points that no joint shapes."""
