"""Damaged files of other programs: each is imported or refused in a sentence, and results load."""
