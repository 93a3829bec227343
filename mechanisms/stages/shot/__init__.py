"""Checks the description of the film: shot.json. It imports loading alone."""
