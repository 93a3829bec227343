"""Blocks on rails, and pins in slots."""
