"""A film as a story: which shots it has, and what each of their frames shows. Without Blender, and without letters."""
