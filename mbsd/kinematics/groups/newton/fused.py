"""A decorator for the small kernels of a block (block.py): LLVM copies them into their caller.

Each has one or two callers, and handing ten arrays on costs more than the work.
"""

from __future__ import annotations

from mbsd.compiling.jit import merged

fused = merged
