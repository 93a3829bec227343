"""Numbers of the page written back into mechanism.py: where they stand, whether that counts, and the file itself."""
