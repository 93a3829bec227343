"""Frames and films, the process of Blender."""
