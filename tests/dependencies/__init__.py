"""Dependencies of a user's code."""
