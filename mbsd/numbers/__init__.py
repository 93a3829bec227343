"""Numbers of a model by name: set in it, varied over many rows, and as arrays beside the old ones."""
