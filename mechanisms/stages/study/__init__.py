"""A mechanism at every point of a grid of its Params, as a table: study.csv."""
