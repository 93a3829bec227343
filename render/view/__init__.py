"""The page: one HTML file with the machine, its forces and its plots, from files alone."""
