"""What must hold before a version is tagged: looked at in a clean clone, each failure by its name."""
