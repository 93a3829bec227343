"""What strays and by how much: spreads, standard classes, pins with play, and the names by which a user gives them."""
