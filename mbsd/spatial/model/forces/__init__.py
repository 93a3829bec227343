"""Forces in space, one kind a file, each a list of rows with the numbers by which they push."""
