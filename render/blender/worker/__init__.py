"""The process that renders, inside Blender."""
