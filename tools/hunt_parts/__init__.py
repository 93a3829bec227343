"""Automatic parts for random mechanisms of all kinds: do they fit, and is what is refused refused for a reason."""
