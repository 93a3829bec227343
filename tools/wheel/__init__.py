"""The solver alone as sdist and wheels."""
