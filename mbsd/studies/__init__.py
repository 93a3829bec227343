"""Parameter studies: a mechanism built and measured at every point of a grid, also on a cluster."""
