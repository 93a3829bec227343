"""Functions of time as quintic pieces that kernels evaluate: pulses, kinks and jumps are looked for and met."""
