"""A mechanism at rest, small motions about a state, efforts that make a motion, suspicious numbers."""
