"""Kinds of forces, one file a kind; kind.py says what they are made of."""
