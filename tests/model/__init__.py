"""Models, laws and what users call."""
