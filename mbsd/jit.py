"""The one decorator for compiled kernels, and where their machine code is kept.

numba's disk cache does not notice an edit in an *imported* file (numba issue 9483): a caller would silently keep
the old numbers. So the cache lives in a folder named after a hash of all sources of this package.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

_PACKAGE = Path(__file__).parent


def _cache_folder() -> Path:
    digest = hashlib.sha256()
    for source in sorted(_PACKAGE.rglob("*.py")):
        digest.update(source.relative_to(_PACKAGE).as_posix().encode())
        digest.update(source.read_bytes())
    name = f"numba-{digest.hexdigest()[:16]}"
    user_cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mbsd"
    for parent in (_PACKAGE / "__pycache__", user_cache, Path(tempfile.gettempdir()) / "mbsd"):
        folder = parent / name
        try:
            if not folder.is_dir():
                folder.mkdir(parents=True)
                for stale in parent.glob("numba-*"):
                    if stale != folder:
                        shutil.rmtree(stale, ignore_errors=True)
            if os.access(folder, os.W_OK):
                return folder
        except OSError:
            continue
    raise OSError("no folder is writable for compiled code; set XDG_CACHE_HOME to one that is")


os.environ.setdefault("NUMBA_CACHE_DIR", str(_cache_folder()))
os.environ.setdefault("NUMBA_CPU_NAME", "generic")  # one code for all machines, and faster on loops this short

import numba  # noqa: E402  (the folder must be set first)
from numba.core.dispatcher import Dispatcher  # noqa: E402

from mbsd.compile_notice import give_notice  # noqa: E402

give_notice()
numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"]  # in case numba was imported before us: it read other words
numba.config.CPU_NAME = os.environ["NUMBA_CPU_NAME"]
if numba.config.CPU_NAME == "generic":
    numba.config.CPU_FEATURES = os.environ.get("NUMBA_CPU_FEATURES", "")

_OPTIONS = {"cache": True, "error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True, "no_rewrites": True}
# _nrt off: kernels allocate nothing, and without it numba counts references to every array of a tuple (2x slower)

kernel = numba.njit(**_OPTIONS)
"""Compile for float64 arrays; IEEE division, no re-association, so the numbers do not depend on the compiler.
Kernels may not allocate: scratch comes in from outside."""

internal = numba.njit(**_OPTIONS, no_cpython_wrapper=True)  # pyright: ignore[reportCallIssue]
"""The same for kernels that only kernels call: without a wrapper for Python they compile in half the time."""

inlined = numba.njit(**_OPTIONS, inline="always")
"""The same for kernels whose body is copied into the caller: passing a System by value costs more than the work."""

threaded = numba.njit(**_OPTIONS, nogil=True)
"""The same for kernels that run in several threads at once, each with scratch of its own."""


OFTEN = 20
"""Calls after which it pays to look up types once and for all."""


class Often:
    """A kernel called over and over with arguments of the same types.

    numba looks at the types of all arguments in each call, 8 us for the arrays of a run: as long as 120 evaluations of
    a pendulum. After some calls this hands out the machine code itself. Arguments must then have the types, memory
    layouts included, of the call before; nothing checks it.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function, self._calls = function, 0

    def __call__(self, *arguments: Any) -> Any:
        """As the kernel does."""
        self._calls += 1
        if self._calls == OFTEN and isinstance(self._function, Dispatcher):
            self._function = self._function.compile(tuple(map(self._function.typeof_pyval, arguments)))
        return self._function(*arguments)
