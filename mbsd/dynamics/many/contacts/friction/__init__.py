"""Contacts with friction in the compiled loop: normal forces and friction together, which contacts slide and stick."""
