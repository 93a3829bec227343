"""Files of other programs, and the mechanisms that they become."""
