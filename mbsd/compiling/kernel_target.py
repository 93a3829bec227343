"""One machine code for all processors of a kind: kernels are compiled for generic x86-64 or arm64.

numba compiles for the processor it runs on, and its settings hold for the whole process. A target of our own leaves
the user's functions and settings as they are; both share types, so each calls the other.
"""

from __future__ import annotations

import copy
import threading
from typing import Any

from numba.core import registry, types
from numba.core.datamodel.models import OpaqueModel
from numba.core.registry import CPUTarget
from numba.core.targetconfig import ConfigStack
from numba.core.typing import Context

from mbsd.compiling.kernel_arguments import MODELS, KernelContext
from mbsd.compiling.kernel_library import KernelCode

_LOCK = threading.Lock()


class _Function(types.Function):
    """A function of numba's; what a call of it gives is found once for the same arguments and flags.

    numba looks through all that is known of ``+`` and ``[]`` at each place where they stand, and again when it writes
    the code.
    """

    def __init__(self, template: Any) -> None:
        super().__init__(template)
        self._found: dict[Any, Any] = {}

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        if kws or not isinstance(context, _Types):
            return super().get_call_type(context, args, kws)
        key = context.kind_of_flags(), tuple(args)
        if key not in self._found:
            self._found[key] = super().get_call_type(context, args, kws)
        return self._found[key]


MODELS.register(_Function, OpaqueModel)


class _Types(Context):
    """numba's own types, with functions that remember."""

    def __init__(self, shared: Any) -> None:
        self.__dict__.update(shared.__dict__)
        self._ours: dict[Any, _Function] = {}
        self._found: dict[Any, Any] = {}
        self._flags: dict[int, tuple[Any, int]] = {}
        self._kinds: dict[Any, int] = {}

    def _get_global_type(self, gv: Any) -> Any:
        kind = super()._get_global_type(gv)
        if type(kind) is not types.Function:
            return kind
        if kind not in self._ours:
            self._ours[kind] = _Function(kind.templates)
        return self._ours[kind]

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        if kws or isinstance(func, types.Dispatcher):
            return super().resolve_function_type(func, args, kws)
        key = self.kind_of_flags(), func, tuple(args)
        if key not in self._found:
            self._found[key] = super().resolve_function_type(func, args, kws)
        return self._found[key]

    def kind_of_flags(self) -> int:
        """Return the number of the flags with which a kernel is compiled; equal ones have the same."""
        flags = ConfigStack.top_or_none()
        if id(flags) not in self._flags:
            kind = self._kinds.setdefault(None if flags is None else flags.copy(), len(self._kinds))
            self._flags[id(flags)] = flags, kind  # flags stay, and so does their id
        return self._flags[id(flags)][1]


class _GenericTarget(CPUTarget):
    """numba's own target but for the processor."""

    def __init__(self) -> None:
        super().__init__("cpu")
        self._context: Any = None
        self._types: Any = None

    @property
    def typing_context(self) -> Any:
        """Shares all it knows with that of numba's own target."""
        with _LOCK:
            if self._types is None:
                self._types = _Types(registry.cpu_target.typing_context)
            return self._types

    @property
    def target_context(self) -> Any:
        """Made at first use: a copy that shares all definitions with numba's own, and generates other code."""
        types_ = self.typing_context
        with _LOCK:
            if self._context is None:
                context = copy.copy(registry.cpu_target.target_context)
                context.__class__ = KernelContext
                context.cached_internal_func = {}
                context.__dict__.pop("nrt", None)  # it knows the context that it was made for
                context._internal_codegen = KernelCode("mbsd.exec")
                context.typing_context = types_
                context.data_model_manager = MODELS
                self._context = context
            return self._context


GENERIC = _GenericTarget()
