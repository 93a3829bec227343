"""Looks as data: light, ground, background and exposure of a picture; Blender and the page translate them."""
