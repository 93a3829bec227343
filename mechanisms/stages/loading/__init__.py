"""Reads the files that an author writes, and finds what these depend on. It imports no other stage."""
