"""The program ``mbsd``: its table, a user's own folder, mbsd.toml, what other programs read."""
