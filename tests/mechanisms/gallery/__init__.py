"""Mechanisms of the gallery against closed forms and published numbers."""
