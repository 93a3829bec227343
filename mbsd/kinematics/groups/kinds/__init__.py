"""Groups solved in closed form, a file each: columns, numbers, positions with rates, columns of B."""
