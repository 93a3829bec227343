"""Change points, where two assemblies meet: how a driven motion passes them, and the poses beside them."""
