"""Joints that stick, and friction of joints beside contacts."""
