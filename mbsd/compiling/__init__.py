"""How kernels are compiled and kept, and how they call functions of the user. It imports base alone."""
