"""Events: what is watched, when it is zero, what changes then."""
