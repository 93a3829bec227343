"""Kernels without Python: machine code of a mechanism's equations, and its arrays as one block."""
