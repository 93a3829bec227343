"""Events of the user within steps of the compiled loop: where they pass zero, and what they do then."""
