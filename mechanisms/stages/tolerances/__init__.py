"""What parts as they are made do to a mechanism, by its tolerances.py: tables, plots, which dimension to tighten."""
