"""Change points, where two assemblies meet: passages of a driven motion, and poses beside them."""
