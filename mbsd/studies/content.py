"""What functions compute, as a hash: their code, what it refers to, and what they were closed over.

Comments, names of files and places in them do not count, so that moving a function redoes nothing; the constants and
helper functions that it uses do, wherever they stand in the user's own files. Of installed packages the names alone
count.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import pickle
import site
import sys
import sysconfig
from collections.abc import Callable
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

import mbsd
from mbsd.base.errors import ModelError
from mbsd.base.shown import shown

_PLACES = {sysconfig.get_paths()[name] for name in ("stdlib", "platstdlib", "purelib", "platlib")}
INSTALLED = tuple(str(Path(place).resolve()) for place in _PLACES | set(site.getsitepackages()))
"""Folders of what is installed; all else is the user's."""
PACKAGE = Path(mbsd.__file__).parent


class Content:
    """Hashes functions and values; ``modules`` are those of the user that it met, for sending them along.

    Where it is not strict, what has no content of its own does not count.
    """

    def __init__(self, strict: bool = True) -> None:
        self.strict = strict
        self.modules: dict[str, ModuleType] = {}
        self._digest = hashlib.sha256()
        self._seen: dict[int, int] = {}
        self._kept: list[object] = []  # so that no number in _seen is used for another object

    def hexdigest(self) -> str:
        """The hash of all that was added."""
        return self._digest.hexdigest()

    def add(self, value: Any) -> Content:
        """Count a function or value. Raises ModelError for one that has no content of its own."""
        if value is None or isinstance(value, bool | int | float | complex | str | bytes):
            self._tell(type(value).__name__, repr(value))
            return self
        if id(value) in self._seen:
            self._tell("again", str(self._seen[id(value)]))
            return self
        self._seen[id(value)] = len(self._seen)
        self._kept.append(value)
        self._compound(value)
        return self

    def _compound(self, value: Any) -> None:
        match value:
            case list() | tuple():
                self._all(type(value).__name__, value)
            case dict():
                self._all("dict", [part for pair in value.items() for part in pair])
            case set() | frozenset():
                self._all("set", sorted(Content().add(part).hexdigest() for part in value))
            case np.ndarray() if value.dtype != object:
                self._tell("array", f"{value.dtype.str} {value.shape}")
                self._digest.update(np.ascontiguousarray(value).tobytes())
            case functools.partial():
                self._all("partial", [value.func, value.args, value.keywords])
            case MethodType():
                self._all("method", [value.__func__, value.__self__])
            case ModuleType():
                self._module(value)
            case CodeType():
                self._code(value)
            case FunctionType():
                self._function(value)
            case type():
                self._class(value)
            case BuiltinFunctionType() | np.ufunc():
                self._tell("function", repr(getattr(value, "__module__", None)) + value.__name__)
            case _:
                self._other(value)

    def _all(self, kind: str, parts: Any) -> None:
        self._tell(kind, str(len(parts)))
        for part in parts:
            self.add(part)

    def _function(self, function: Callable[..., Any]) -> None:
        if self._is_installed(function):
            self._tell("function", f"{function.__module__}.{function.__qualname__}")
            return
        self._tell("function", function.__qualname__.rpartition(".")[2])
        self.add(function.__code__)
        self.add(function.__defaults__)
        self.add(function.__kwdefaults__)
        for cell in function.__closure__ or ():
            try:
                self.add(cell.cell_contents)
            except ValueError:  # a name that is not bound yet
                self._tell("cell", "empty")
        for name in sorted(_names(function.__code__)):
            if name in function.__globals__:
                self._tell("global", name)
                self.add(function.__globals__[name])

    def _code(self, code: CodeType) -> None:
        self._tell(
            "code", f"{sys.version_info[:2]} {code.co_flags} {code.co_varnames} {code.co_names} {code.co_argcount}"
        )
        self._digest.update(code.co_code)
        self._all("constants", code.co_consts)

    def _class(self, cls: type) -> None:
        self._tell("class", f"{cls.__module__}.{cls.__qualname__}")
        if self._is_installed(cls):
            return
        for name, member in sorted(vars(cls).items()):
            if name in ("__dict__", "__weakref__", "__module__", "__firstlineno__", "__static_attributes__"):
                continue
            member = getattr(member, "__func__", member)
            if isinstance(member, property):
                self._all(name, [member.fget, member.fset])
            elif isinstance(member, FunctionType | bool | int | float | str | tuple | list | dict):
                self._tell("member", name)
                self.add(member)

    def _module(self, module: ModuleType) -> None:
        self._tell("module", module.__name__)
        if not self._is_installed(module):
            self._digest.update(Path(inspect.getfile(module)).read_bytes())

    def _other(self, value: Any) -> None:
        try:
            self._tell("pickle", type(value).__qualname__)
            self._digest.update(pickle.dumps(value, protocol=5))
            self.add(type(value))
        except Exception as error:
            if not self.strict:
                return
            raise ModelError(
                f"study: build or measure refers to {shown(value)}, whose content is unknown ({error}); refer to "
                "functions, numbers, texts and arrays, or give folder=None, so that nothing is kept"
            ) from error

    def _is_installed(self, one: Any) -> bool:
        """Whether it is of the library or of an installed package; a module of the user is noted."""
        name = one.__name__ if isinstance(one, ModuleType) else getattr(one, "__module__", None)
        module = sys.modules.get(name or "")
        file = getattr(module, "__file__", None)
        if name != "__main__" and (file is None or _under(file)):
            return module is not None
        if module is not None and name is not None:
            self.modules[name] = module
        return False

    def _tell(self, kind: str, text: str) -> None:
        self._digest.update(f"{kind} {len(text)} {text}\0".encode())


def _under(file: str) -> bool:
    path = Path(file).resolve()
    return path.is_relative_to(PACKAGE) or str(path).startswith(INSTALLED)


def _names(code: CodeType) -> set[str]:
    """Global names that code and the functions within refer to."""
    inner = [one for one in code.co_consts if isinstance(one, CodeType)]
    return set(code.co_names).union(*map(_names, inner))


@functools.cache
def own_sources() -> str:
    """SHA-256 over the sources of this package, by name and content."""
    digest = hashlib.sha256(mbsd.__version__.encode())
    for file in sorted(PACKAGE.rglob("*.py")):
        digest.update(file.relative_to(PACKAGE).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()
