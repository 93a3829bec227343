"""Builders of pictures, tables, films and the lecture of docs/, by ``python -m tools.documents``."""
