"""Names in, arrays out, and what Python asks of kernels along a motion."""
