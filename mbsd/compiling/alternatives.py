"""One name for several kernels: which of them a call means follows from the first argument of the kernel that calls.

    accelerate = alternatives({Dynamics: ..., Embedding: ...})

    @kernel
    def advance(dyn, ...): ... accelerate(dyn, ...) ...

A kernel is compiled for each class of named tuples that it gets as its first argument, and the pipeline then puts the
kernel of that class in place of the name (kernel_pipeline.py): nothing is decided at run time, and no machine code
contains what another class needs.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from numba.core import ir, types


class Alternatives:
    """Kernels by the class of their first argument."""

    def __init__(self, kernels: Mapping[type, Any]) -> None:
        self.kernels = dict(kernels)

    def __call__(self, first: Any, *rest: Any) -> Any:
        """The call itself, where nothing is compiled."""
        return self.of(type(first))(first, *rest)

    def of(self, kind: type) -> Any:
        """The kernel of a class; raises TypeError where there is none."""
        if kind not in self.kernels:
            names = ", ".join(known.__name__ for known in self.kernels)
            raise TypeError(f"there is no kernel for {kind.__name__}, only for {names}")
        return self.kernels[kind]


def alternatives(kernels: Mapping[type, Any]) -> Any:
    """A name for all of them."""
    return Alternatives(kernels)


def kernel_for(name: Any, arguments: Sequence[Any]) -> Any:
    """The kernel that a name means for arguments of numba's types ``arguments``."""
    return name.of(arguments[0].instance_class) if isinstance(name, Alternatives) else name


def choose(blocks: Iterable[ir.Block], first: Any) -> None:
    """Put kernels in place of their names in a kernel's code; ``first`` is numba's type of its first argument."""
    if not isinstance(first, types.BaseNamedTuple):
        return
    for block in blocks:
        for statement in block.body:
            value = statement.value if isinstance(statement, ir.Assign) else None
            if isinstance(value, ir.Global | ir.FreeVar) and isinstance(value.value, Alternatives):
                value.value = value.value.of(first.instance_class)
