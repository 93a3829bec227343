"""A new mechanism that already runs, from templates."""
