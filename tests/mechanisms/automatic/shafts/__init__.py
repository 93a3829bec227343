"""Parts of machines whose bodies have places along the normal of the plane."""
