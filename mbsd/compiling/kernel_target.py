"""One machine code for all processors of a kind: kernels are compiled for generic x86-64 or arm64.

numba compiles for the processor it runs on, and its settings hold for the whole process. A target of our own leaves
the user's functions and settings as they are; both share types, so each calls the other.
"""

from __future__ import annotations

import copy
import threading
from typing import Any

from numba.core import registry
from numba.core.codegen import JITCPUCodegen
from numba.core.registry import CPUTarget

_LOCK = threading.Lock()


class _GenericCode(JITCPUCodegen):
    """Asks no processor what it can."""

    def _get_host_cpu_name(self) -> str:
        return "generic"

    def _get_host_cpu_features(self) -> str:
        return ""


class _GenericTarget(CPUTarget):
    """numba's own target but for the processor."""

    def __init__(self) -> None:
        super().__init__("cpu")
        self._context: Any = None

    @property
    def typing_context(self) -> Any:
        """Shared with numba's own target."""
        return registry.cpu_target.typing_context

    @property
    def target_context(self) -> Any:
        """Made at first use: a copy that shares all definitions with numba's own, and generates other code."""
        with _LOCK:
            if self._context is None:
                context = copy.copy(registry.cpu_target.target_context)
                context.cached_internal_func = {}
                context.__dict__.pop("nrt", None)  # it knows the context that it was made for
                context._internal_codegen = _GenericCode("mbsd.exec")
                self._context = context
            return self._context


GENERIC = _GenericTarget()
