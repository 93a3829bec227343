"""Companions of the workers of the rounds: a lying worker, and a study."""
