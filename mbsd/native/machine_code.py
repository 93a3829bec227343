"""Machine code of kernels and their callees for any program, without numba, Python or addresses.

A kernel's module in LLVM's own language is kept beside its machine code. Those of the entries, of what they call and of
the kernels behind their cells (mbsd/compiling/lazy_kernel.py) are linked into one, what nobody calls is dropped, and
LLVM makes position-independent code of it. Cells become constants that hold the address of their kernel.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import llvmlite.binding as llvm
import numpy as np
from numba.core import types

from mbsd.arrays.directory import directory
from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.compiling.alternatives import kernel_for
from mbsd.compiling.jit import kernel
from mbsd.compiling.lazy_kernel import COMPILE
from mbsd.equations.interactions.evaluation import apply
from mbsd.equations.loads import Loads
from mbsd.model.joint import SPECIALS
from mbsd.native.memory import reader

TABLE = types.CPointer(types.int64)
LIBRARY = {"sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "expm1", "log",
           "log1p", "log2", "log10", "pow", "hypot", "fabs", "floor", "ceil", "fmod", "trunc", "round", "cbrt", "erf",
           "copysign", "ldexp", "frexp", "memset", "memcpy", "memmove"}  # fmt: skip
"""Functions of the C library, which every program has."""
OF_PYTHON = re.compile(r"Py[A-Z_]\w*|_Py\w*|numba_\w+|NRT_\w+")
"""Names that wrappers for Python use: they are never run, and get functions that do nothing."""
ALLOCATES = re.compile(r"NRT_\w*alloc\w*")


@dataclass
class MachineCode:
    """Kernels that are linked together, each under a name of its own.

    An entry is ``int32_t name(result *, void **, int64_t *table)``, a function at an address what its signature says.
    """

    names: dict[str, str] = field(default_factory=dict)
    """Names inside by the name outside."""
    libraries: list[Any] = field(default_factory=list)

    def add_entry(self, name: str, function: Any, kinds: Sequence[Any]) -> None:
        """A kernel for arguments of numba's types ``kinds``, read from a table (table.py)."""
        read, function = reader(types.Tuple(tuple(kinds))), kernel_for(function, kinds)

        def call(table):
            return function(*read(table))

        frame = kernel(call)
        frame.compile((TABLE,))
        made = frame.overloads[(TABLE,)]
        self._add(name, made.fndesc.llvm_func_name, made.library)

    def add_address(self, name: str, function: Any) -> None:
        """A function that kernels call by its address (numba's CFunc)."""
        self._add(name, function._wrapper_name, function._library)

    def _add(self, name: str, inside: str, library: Any) -> None:
        self.names[name] = inside
        self.libraries.append(library)

    def assembly(self, triple: str | None = None) -> str:
        """All of it in the assembler's language of a platform, this one by default."""
        llvm.initialize_all_targets()
        llvm.initialize_all_asmprinters()
        module = self._linked()
        module.triple = triple or llvm.get_process_triple()
        target = llvm.Target.from_triple(module.triple)
        machine = target.create_target_machine(cpu="", features="", opt=2, reloc="pic", codemodel="default")
        module.data_layout = str(machine.target_data)
        return machine.emit_assembly(module)

    def _linked(self) -> Any:
        libraries, cells = _needed(self.libraries)
        module = llvm.parse_assembly(_head(self.names, cells))
        for library in libraries:
            module.link_in(llvm.parse_bitcode(_bitcode(library)))
        _keep_inside(module, self.names)
        _drop_unused(module)
        _rename(module, self.names)
        stand_ins = _stand_ins(module)
        if stand_ins:
            module.link_in(llvm.parse_assembly(stand_ins))
        return module


def _bitcode(library: Any) -> bytes:
    own = getattr(library, "own_module", library._get_module_for_linking)
    return own().as_bitcode()


def _needed(libraries: Iterable[Any]) -> tuple[list[Any], dict[str, str]]:
    """All libraries that these call, and by the name of each cell the name of the kernel that it leads to."""
    waiting, seen, cells = [*libraries], {}, {}
    while waiting:
        library = waiting.pop()
        if id(library) in seen:
            continue
        seen[id(library)] = library
        for called in getattr(library, "calls", {}).values():
            made = called.library
            assert made is not None, called.name
            waiting.append(made)
        for cell in getattr(library, "cells", {}).values():
            cell.fill()
            made = cell.dispatcher.overloads[cell.arguments]
            cells[cell.name] = made.fndesc.llvm_func_name
            waiting.append(made.library)
    return list(seen.values()), cells


def _head(names: Mapping[str, str], cells: Mapping[str, str]) -> str:
    """A module in which every name from outside and every cell holds the address of its function."""
    lines = [f'declare void @"{inside}"()' for inside in sorted({*names.values(), *cells.values()})]
    lines += [f'@"{cell}" = constant ptr @"{inside}"' for cell, inside in sorted(cells.items())]
    lines += [f'@"{name}" = hidden constant ptr @"{inside}"' for name, inside in sorted(names.items())]
    lines.append(f'define i32 @"{COMPILE}"(ptr) {{\n  ret i32 2\n}}')
    return "\n".join(lines) + "\n"


def _keep_inside(module: Any, names: Mapping[str, str]) -> None:
    """Let nothing but ``names`` be seen from outside."""
    for value in _inside(module, names):
        value.linkage = "internal"


def _inside(module: Any, names: Mapping[str, str]) -> list[Any]:
    return [
        value
        for value in [*module.functions, *module.global_variables]
        if not value.is_declaration and value.name not in names and not value.name.startswith("llvm.")
    ]


def _rename(module: Any, names: Mapping[str, str]) -> None:
    """Short names, which do not depend on what this process compiled before."""
    for k, value in enumerate(_inside(module, names)):
        value.name = f"mbsd_{k}"


def _drop_unused(module: Any) -> None:
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    target = llvm.Target.from_default_triple().create_target_machine()
    passes.run(module, llvm.create_pass_builder(target, llvm.create_pipeline_tuning_options()))


def _stand_ins(module: Any) -> str:
    """Return empty definitions of names in wrappers.

    Raises ModelError for names that no program without Python has.
    """
    lines = []
    for function in module.functions:
        name = function.name
        if not function.is_declaration or name.startswith("llvm.") or name in LIBRARY:
            continue
        if not OF_PYTHON.fullmatch(name) or ALLOCATES.fullmatch(name):
            raise ModelError(
                f"a compiled function of the model calls {name}, which only Python's process has; let it allocate "
                "nothing and return numbers"
            )
        lines.append(f'define ptr @"{name}"() {{\n  ret ptr null\n}}')
    lines += [
        f'@"{value.name}" = global ptr null'
        for value in module.global_variables
        if value.is_declaration and OF_PYTHON.fullmatch(value.name)
    ]
    return "\n".join(lines) + "\n" if lines else ""


FORCE, APPLY = 4, 5
"""Columns of Loads.interaction with addresses."""


def functions_at(packed: Packed, loads: Loads) -> Iterator[tuple[np.ndarray, tuple[int, ...], str, Any]]:
    """Array, entry, name and function (numba's CFunc) of each address that is not a user's."""
    for k, name in enumerate(packed.specials.names):
        equation = SPECIALS[name].equation
        made = importlib.import_module(f"mbsd.equations.relative.{equation}").residual
        yield packed.system.address, (k,), f"relative_{equation}", made
    for rows in directory(packed).values():
        for interaction, row in zip(rows.interactions, rows.interaction, strict=True):
            made = importlib.import_module(f"mbsd.equations.interactions.{interaction.function}").force
            yield loads.interaction, (row, FORCE), f"interaction_{interaction.function}", made
            yield loads.interaction, (row, APPLY), "apply_interactions", apply
