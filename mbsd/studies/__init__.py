"""Parameter studies: a mechanism built and measured at every point of a grid, on all cores or on many machines."""
