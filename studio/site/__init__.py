"""Site: a wall of mechanisms in motion, and a page of each with its film, sliders and files."""
