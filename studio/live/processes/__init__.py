"""Processes with the author's code: how they begin and answer, and how all end with the server."""
