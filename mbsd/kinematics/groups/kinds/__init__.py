"""The groups solved in closed form, a file each: columns, numbers, positions with rates, places alone, columns of B."""
