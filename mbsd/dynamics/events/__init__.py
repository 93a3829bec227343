"""Events: which scalars are monitored, when one passes zero, what changes then."""
