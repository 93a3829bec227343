"""Functions of time as quintic pieces for kernels, which resolve pulses, kinks and jumps."""
