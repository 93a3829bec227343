"""Joints that stick, and friction of joints beside contacts, in the compiled loop."""
