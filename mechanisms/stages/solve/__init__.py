"""Solves the motion: masses, run and data.json. It imports loading alone."""
