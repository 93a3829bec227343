"""Numbers of the page written back into mechanism.py: their places, their effect, the file itself."""
