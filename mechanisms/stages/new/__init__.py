"""Makes a new mechanism from templates. It imports no other stage."""
