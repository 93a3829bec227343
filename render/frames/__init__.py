"""Frames, the store that keeps them, and the film they make. It imports film and blender."""
