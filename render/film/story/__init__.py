"""A film as a story: its shots, and the content of each frame, without Blender and without letters."""
