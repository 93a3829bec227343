"""Contacts with friction: forces, and what slides or sticks."""
