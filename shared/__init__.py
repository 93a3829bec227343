"""Code that both the solver's and the pictures' rooms use; it imports no other room."""
