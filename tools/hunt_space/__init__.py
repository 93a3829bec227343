"""Random mechanisms in space, whose accelerations and reactions an independent Newton-Euler implementation checks."""
