"""Dimensions that vary and by how much: spreads, standard classes, pins with play, and their names."""
