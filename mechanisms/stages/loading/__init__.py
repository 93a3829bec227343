"""Loads what an author writes, and finds what it depends on. It knows no other stage."""
