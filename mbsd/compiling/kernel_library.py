"""Machine code of one kernel: its callees are called in place, neither copied nor optimised again.

numba links the code of every callee into every caller and optimises all of it again, for each compiled function; the
derivative of a motion is in twenty of them. Here a kernel that stands apart is a name, which the engine resolves to
the one copy. Such names must be the same in every process (kernel_pipeline.py), and who reads a caller from the cache
reads its callees first (kernel_cache.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import llvmlite.binding as llvm
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen

from mbsd.compiling.kernel_arguments import refuse_others

LINKED = "linked"
"""Mark of a library of which there is no machine code."""


@dataclass(frozen=True)
class Apart:
    """A kernel that stands apart, for one signature."""

    name: str
    """In machine code."""
    dispatcher: Any
    arguments: tuple[Any, ...]
    """numba's types."""

    @property
    def library(self) -> KernelLibrary | None:
        """Its machine code, which is there from now on; None if it has another name."""
        self.dispatcher.compile(self.arguments)
        made = self.dispatcher.overloads[self.arguments]
        return made.library if made.fndesc.llvm_func_name == self.name else None


class _WithoutCallees:
    """A library as ours link it: kernels that it calls and that stand apart are left out."""

    def __init__(self, library: Any) -> None:
        self._reload_init = getattr(library, "_reload_init", [])  # numba 0.61 has none
        self._library = library

    def _get_module_for_linking(self) -> Any:
        return self._library.own_module()


class KernelLibrary(JITCodeLibrary):
    """numba's library but for kernels that stand apart."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.only_linked = False
        """True if it is linked into its callers and never run itself."""
        self.apart: Apart | None = None
        """This library as its callers see it, if it is not linked into them."""
        self.calls: dict[str, Apart] = {}
        """Kernels that must be loaded before this one, by name."""
        self.cells: dict[str, Any] = {}
        """Cells of kernels that it compiles when it calls them, by name (lazy_kernel.py)."""

    def note_cell(self, cell: Any) -> None:
        """Note that code of this library names the cell."""
        self.cells[cell.name] = cell

    def finalize(self) -> None:
        """Optimise it together with what does not stand apart, and make machine code."""
        linked = []
        for library in dict.fromkeys(self._linking_libraries):
            if not isinstance(library, KernelLibrary):
                refuse_others(self._final_module, library._get_module_for_linking())
                linked.append(library)
            elif library.apart is not None:
                self.calls[library.apart.name] = library.apart
            else:
                self.calls.update(library.calls)
                self.cells.update(library.cells)
                linked.append(_WithoutCallees(library))
        self._linking_libraries = linked
        super().finalize()

    def _finalize_final_module(self) -> None:
        """Make machine code, unless nobody runs it where it stands."""
        if not self.only_linked:
            super()._finalize_final_module()
            return
        self._finalize_dynamic_globals()
        self._finalized = True

    def own_module(self) -> Any:
        """Return the module for linking into another library of ours."""
        return super()._get_module_for_linking()

    def _get_module_for_linking(self) -> Any:
        """Return the module with all that it calls, for linking into another engine's."""
        whole = self.own_module()
        if self.calls:
            whole = whole.clone()
            for called in self.calls.values():
                library = called.library
                assert library is not None, called.name
                whole.link_in(library._get_module_for_linking(), preserve=True)
        return whole

    def serialize_using_object_code(self) -> Any:
        """Return the library without what it calls, which has a file of its own."""
        self._ensure_finalized()
        module = self.own_module().as_bitcode()
        return (
            (self.name, LINKED, module)
            if self.only_linked
            else (self.name, "object", (self._get_compiled_object(), module))
        )

    @classmethod
    def _unserialize(cls, codegen: Any, state: Any) -> Any:
        """Return the library from what was kept."""
        name, kind, data = state
        if kind != LINKED:
            return super()._unserialize(codegen, state)
        library = codegen.create_library(name)
        library.only_linked = True
        library._final_module = llvm.parse_bitcode(data)
        library._finalize_final_module()
        return library

    def _optimize_functions(self, ll_module: Any) -> None:
        """Do nothing: the whole module is optimised once, at the end."""
        ll_module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        """Optimise once: numba's first, cheap round serves reference counts, of which kernels have none."""
        manager = self._codegen._module_pass_manager()
        if isinstance(manager, tuple):
            manager[0].run(self._final_module, manager[1])
        else:  # numba before 0.62
            manager.run(self._final_module)


class KernelCode(JITCPUCodegen):
    """Asks no processor what it can."""

    _library_class = KernelLibrary

    def _get_host_cpu_name(self) -> str:
        return "generic"

    def _get_host_cpu_features(self) -> str:
        return ""

    def _pass_builder(self, **options: Any) -> Any:
        """Return passes without vectors: loops of three to twelve turns gain nothing from them."""
        return super()._pass_builder(**options | {"loop_vectorize": False, "slp_vectorize": False})
