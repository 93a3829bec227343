"""The process that renders: everything here runs inside Blender."""
