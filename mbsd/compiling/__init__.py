"""How kernels are compiled and kept, and how they call functions of the user. It imports base alone."""

from mbsd.compiling.numba_version import refuse_other_versions

refuse_other_versions()  # before a part of numba is imported that another version may lack
