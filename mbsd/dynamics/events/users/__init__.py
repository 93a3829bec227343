"""Events of the user in the compiled loop."""
