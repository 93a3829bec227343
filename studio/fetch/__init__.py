"""Films come home: `python -m studio.fetch user@machine` brings them with rsync, what has changed alone."""
