"""One name for several kernels, chosen by the first argument of the calling kernel.

    accelerate = alternatives({Dynamics: ..., Embedding: ...})

    @kernel
    def advance(dyn, ...): ... accelerate(dyn, ...) ...

A kernel is compiled for each class of named tuples that it gets as its first argument, and the pipeline then puts the
kernel of that class in place of the name (kernel_pipeline.py): nothing is decided at run time, and no machine code
contains what another class needs. A room above may add its own class (:meth:`Alternatives.add`); what is compiled for
it is then kept by the files of its kernels as well (kernel_cache.py).
"""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from numba.core import ir, types

_ADDED: dict[type, set[str]] = {}
"""Files of the kernels of classes that were added."""


class Alternatives:
    """Kernels by the class of their first argument."""

    def __init__(self, kernels: Mapping[type, Any], otherwise: Any = None) -> None:
        """Keep kernels by class; ``otherwise`` is that of all classes that have none of their own."""
        self.kernels, self.otherwise = dict(kernels), otherwise

    def __call__(self, first: Any, *rest: Any) -> Any:
        """Call the kernel of the first argument's class, where nothing is compiled."""
        return self.kernel_of(type(first))(first, *rest)

    def add(self, kind: type, kernel: Any) -> None:
        """Add the kernel of another class of named tuples; raises ValueError if the class has one."""
        if kind in self.kernels:
            raise ValueError(f"{kind.__name__} has a kernel here already")
        self.kernels[kind] = kernel
        file = inspect.getsourcefile(getattr(kernel, "py_func", kernel))
        _ADDED.setdefault(kind, set()).update([file] if file else [])

    def kernel_of(self, kind: type) -> Any:
        """Return the kernel of a class; raises TypeError where there is none."""
        if kind not in self.kernels and self.otherwise is None:
            names = ", ".join(known.__name__ for known in self.kernels)
            raise TypeError(f"there is no kernel for {kind.__name__}, only for {names}")
        return self.kernels.get(kind, self.otherwise)


def alternatives(kernels: Mapping[type, Any], otherwise: Any = None) -> Any:
    """Return a name for kernels by the class of their first argument, and one for all other classes."""
    return Alternatives(kernels, otherwise)


def kernel_for(name: Any, arguments: Sequence[Any]) -> Any:
    """Return the kernel that a name means for arguments of numba's types ``arguments``."""
    return name.kernel_of(arguments[0].instance_class) if isinstance(name, Alternatives) else name


def choose(blocks: Iterable[ir.Block], first: Any) -> None:
    """Replace names of kernels in a kernel's code; ``first`` is numba's type of its first argument."""
    if not isinstance(first, types.BaseNamedTuple):
        return
    for block in blocks:
        for statement in block.body:
            value = statement.value if isinstance(statement, ir.Assign) else None
            if isinstance(value, ir.Global | ir.FreeVar) and isinstance(value.value, Alternatives):
                value.value = value.value.kernel_of(first.instance_class)


def files_added(signature: Any) -> tuple[str, ...]:
    """Return the sorted files of kernels that were added for classes among a signature's types."""
    arguments: Iterable[Any] = getattr(signature, "args", signature)
    kinds = [kind.instance_class for kind in arguments if isinstance(kind, types.BaseNamedTuple)]
    return tuple(sorted({file for kind in kinds for file in _ADDED.get(kind, ())}))
