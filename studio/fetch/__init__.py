"""Fetching of films: ``python -m studio.fetch user@machine`` copies changed films with rsync."""
