"""Arrays in, names out: what a motion was."""
