"""Processes with the author's code: how they begin, what they answer, and that all of them end with the server."""
