"""The proof that no two parts touch."""
