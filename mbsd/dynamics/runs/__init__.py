"""A run in either formulation: its steps, its outputs, its pace, and why it got stuck."""
