"""Hash of what functions compute: their code, what it refers to, and what they were closed over.

Followed is whatever the code can reach by its names: helpers of helpers, attributes of modules, methods and bases of
classes, functions that objects hold. Comments, docstrings, names of files and places in them do not count, so that
moving a function redoes nothing. Modules that are reached as such, or imported within a function, count as a whole with
all that they import (``whole``); of installed packages the versions count.
"""

from __future__ import annotations

import dis
import functools
import hashlib
import os
import sys
import types
import weakref
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path, PurePath
from types import CodeType, FunctionType, MappingProxyType, MethodType, ModuleType
from typing import Any, NamedTuple

import numpy as np

import mbsd
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.dependencies.imported import file_of, resolved
from mbsd.dependencies.installed import is_installed

PACKAGE = Path(mbsd.__file__).parent
PLAIN = (type(None), bool, int, float, complex, str, bytes, type(...), type(NotImplemented))
DESCRIPTORS = (
    types.BuiltinFunctionType,
    types.WrapperDescriptorType,
    types.MethodWrapperType,
    types.MethodDescriptorType,
    types.ClassMethodDescriptorType,
    types.GetSetDescriptorType,
    types.MemberDescriptorType,
    np.ufunc,
)
HAS_DOCSTRING = 0x4000000
"""A flag of code, from Python 3.13 on."""
OF_A_CLASS = {
    *("__dict__", "__weakref__", "__module__", "__qualname__", "__doc__", "__firstlineno__", "__static_attributes__"),
    *("__annotations__", "__annotate__", "__annotate_func__", "__annotations_cache__", "_abc_impl"),
}
"""Members of a class that say nothing of what it does; annotations count by their text."""


class Content:
    """Hashes functions and values; where it is not strict, what has no content of its own does not count.

    Paths below the folder ``root`` count relative to it, so that a copy elsewhere has the same content.
    """

    def __init__(self, strict: bool = True, root: Path | None = None) -> None:
        self.strict = strict
        self._root = None if root is None else str(root)
        self.modules: dict[str, ModuleType] = {}
        """Modules of the user that were met, for sending them along."""
        self.whole: dict[str, ModuleType] = {}
        """Modules that count with all that they import."""
        self.packages: set[str] = set()
        """Top-level names of the installed packages that were met."""
        self.caches: list[Any] = []
        """Functions that remember their results (``functools.cache``)."""
        self._digest = hashlib.sha256()
        self._known: dict[int, bytes] = {}
        self._open: dict[int, int] = {}
        self._attributes: set[tuple[int, str]] = set()
        self._alive: list[object] = []  # so that no number in _known is used for another object

    def hexdigest(self) -> str:
        """Return the hash of all that was added."""
        return self._digest.hexdigest()

    def add(self, value: Any) -> Content:
        """Count a function or value. Raises ModelError for one that has no content of its own."""
        try:
            self._digest.update(self._content(value))
        except RecursionError as error:
            raise ModelError(
                f"study: what {shown(value)} refers to is nested too deeply to be compared; give folder=None, so that "
                "nothing is kept"
            ) from error
        return self

    def _content(self, value: Any) -> bytes:
        if type(value) is str and self._root is not None and (value + os.sep).startswith(self._root + os.sep):
            return _joined("place", value[len(self._root) :])
        if type(value) in PLAIN:
            return _joined(type(value).__name__, repr(value))
        number = id(value)
        if number in self._known:
            return self._known[number]
        if number in self._open:
            return _joined("within", str(self._open[number]))
        self._open[number] = len(self._open)
        try:
            content = self._compound(value)
        finally:
            del self._open[number]
        self._known[number] = content
        self._alive.append(value)
        return content

    def _compound(self, value: Any) -> bytes:
        kind = type(value)
        if kind in (list, tuple):
            return self._all(kind.__name__, value)
        if kind in (dict, MappingProxyType, weakref.WeakKeyDictionary, weakref.WeakValueDictionary):
            return self._mapping(value)
        if kind in (set, frozenset):
            return _joined("set", "", *sorted(map(self._content, value)))
        if kind is np.ndarray:
            if value.dtype.hasobject:
                return self._all("array", [value.shape, value.dtype.str, value.tolist()])
            return _joined("array", f"{value.dtype.str} {value.shape}", np.ascontiguousarray(value).tobytes())
        match value:
            case functools.partial():
                return self._all("partial", [value.func, value.args, value.keywords, vars(value)])
            case MethodType():
                return self._all("method", [value.__func__, value.__self__])
            case ModuleType():
                return self._module(value, ())
            case CodeType():
                return self._code(value)
            case FunctionType():
                return self._function(value)
            case type():
                return self._class(value)
            case property():
                return self._all("property", [value.fget, value.fset, value.fdel])
            case staticmethod() | classmethod():
                return self._all(kind.__name__, [value.__func__])
            case functools.cached_property():
                return self._all("cached_property", [value.func])
            case functools._lru_cache_wrapper():  # pyright: ignore[reportAttributeAccessIssue]
                self.caches.append(value)
                return self._all("cache", [value.__wrapped__, value.cache_parameters()])
            case weakref.ReferenceType():
                return self._all("reference", [value()])
        if kind in DESCRIPTORS:
            return self._built_in(value)
        if isinstance(value, PurePath):
            return self._all(kind.__name__, [str(value)])
        if value is os.environ or value is sys.stdout or value is sys.stderr:  # what is read of it is recorded
            return _joined("of the process", kind.__name__)
        return self._object(value)

    def _all(self, kind: str, parts: Iterable[Any]) -> bytes:
        return _joined(kind, "", *map(self._content, parts))

    def _mapping(self, mapping: Mapping[Any, Any]) -> bytes:
        """Return the order of names does not count."""
        return _joined("dict", "", *sorted(self._content(key) + self._content(value) for key, value in mapping.items()))

    def _built_in(self, function: Any) -> bytes:
        owner = getattr(function, "__objclass__", None) or getattr(function, "__self__", None)
        name = f"{getattr(function, '__module__', None)}.{getattr(function, '__qualname__', function.__name__)}"
        self._installed(str(getattr(function, "__module__", "")))
        has_owner = owner is not None and not isinstance(owner, ModuleType)
        return _joined("built-in", name, self._content(owner) if has_owner else b"")

    def _function(self, function: FunctionType) -> bytes:
        name = str(function.__globals__.get("__name__"))  # __module__ is what functools.wraps made of it
        module = sys.modules.get(name)
        if module is None or vars(module) is not function.__globals__:
            module = None
        elif self._is_installed(module):
            # A decorator of a package is closed over the user's function.
            held = [self._leniently(cell.cell_contents) for cell in function.__closure__ or () if _is_bound(cell)]
            return _joined("function", f"{name}.{function.__qualname__}", *held, self._leniently(vars(function)))
        cells = [self._cell(cell) for cell in function.__closure__ or ()]
        given = [function.__defaults__, function.__kwdefaults__, vars(function)]
        return _joined(
            "function",
            function.__qualname__.rpartition(".")[2],
            self._content(function.__code__),
            self._all("given", given),
            *cells,
            *self._globals(function),
            *self._imports(function, module),
        )

    def _cell(self, cell: types.CellType) -> bytes:
        return self._content(cell.cell_contents) if _is_bound(cell) else b"empty"

    def _globals(self, function: FunctionType) -> Iterable[bytes]:
        named, there = references(function.__code__), function.__globals__
        names = {name for name in there if not name.startswith("__")} if named.any_global else named.globals
        for name in sorted(names & there.keys()):
            value = there[name]
            if name not in named.globals:  # it may be read, by whatever text the code makes
                yield _joined("global", name, self._leniently(value))
            elif isinstance(value, ModuleType):
                yield _joined("global", name, self._module(value, named.attributes))
            else:
                yield _joined("global", name, self._content(value))

    def _leniently(self, value: Any) -> bytes:
        """Return the same for what may not matter: of what has no content of its own the kind counts."""
        strict, self.strict = self.strict, False
        try:
            return self._content(value)
        finally:
            self.strict = strict

    def _imports(self, function: FunctionType, module: ModuleType | None) -> Iterable[bytes]:
        """Yield contents of imports when the function runs; modules that it can find count as a whole."""
        named = references(function.__code__)
        package = str(function.__globals__.get("__package__") or "")
        for name, level, taken in sorted(named.imports):
            base = resolved(name, level, package)
            for module_name in (base, *(f"{base}.{part}" for part in taken)):
                self._count_whole(module_name)
            yield _joined("import", f"{base} {taken}")
        if named.any_module:
            for module_name in list(sys.modules):
                self._count_whole(module_name)
        if named.any_global and module is not None:
            self._count_whole(module.__name__)

    def _count_whole(self, name: str) -> None:
        module = sys.modules.get(name)
        if isinstance(module, ModuleType) and not self._is_installed(module) and file_of(module) is not None:
            self.whole[name] = module

    def _code(self, code: CodeType) -> bytes:
        counts = code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags & ~HAS_DOCSTRING
        names = code.co_varnames, code.co_freevars, code.co_cellvars
        steps = [
            _joined(name, "", self._content(argument) if constant else repr(argument).encode())
            for name, argument, constant in instructions(code)
        ]
        return _joined("code", f"{sys.version_info[:2]} {counts} {names}", code.co_exceptiontable, *steps)

    def _class(self, cls: type) -> bytes:
        name = f"{cls.__module__}.{cls.__qualname__}"
        module = sys.modules.get(cls.__module__)
        if module is not None and self._is_installed(module):
            return _joined("class", name)
        parts = [self._all("bases", [*cls.__bases__, *([] if type(cls) is type else [type(cls)])])]
        for member, value in sorted(vars(cls).items()):
            if member not in OF_A_CLASS:
                parts.append(_joined("member", member, self._member(value)))
        annotations = {n: _text(value) for n, value in (vars(cls).get("__annotations__") or {}).items()}
        return _joined("class", cls.__qualname__, *parts, self._mapping(annotations))

    def _member(self, value: Any) -> bytes:
        try:
            return self._content(value)
        except ModelError:
            if not hasattr(type(value), "__get__"):
                raise
            return _joined("descriptor", f"{type(value).__module__}.{type(value).__qualname__}")

    def _module(self, module: ModuleType, attributes: Iterable[str]) -> bytes:
        """Return a module, and what code with these names reaches in it and in the modules below."""
        name = module.__name__
        if self._is_installed(module):
            return _joined("module", name)
        for other in list(sys.modules):
            if other == name or other.startswith(f"{name}."):
                self._count_whole(other)
        parts = []
        for attribute in sorted({*attributes} & vars(module).keys()):
            if (id(module), attribute) not in self._attributes:
                self._attributes.add((id(module), attribute))
                value = vars(module)[attribute]
                content = self._module(value, attributes) if isinstance(value, ModuleType) else self._content(value)
                parts.append(_joined("attribute", attribute, content))
        return _joined("module", name, *parts)

    def _object(self, value: Any) -> bytes:
        """Return the content of what pickle would keep of an object, functions and classes included."""
        kind = type(value)
        if kind.__module__.partition(".")[0] == "numba" and isinstance(getattr(value, "py_func", None), FunctionType):
            return self._all("compiled", [value.py_func, getattr(value, "targetoptions", None)])
        try:
            reduced = value.__reduce_ex__(4)
        except RecursionError:
            raise
        except Exception as error:
            if not self.strict:
                return _joined("unknown", kind.__qualname__)
            raise ModelError(
                f"study: build or measure refers to {shown(value)}, whose content is unknown ({error}); refer to "
                "functions, numbers, texts and arrays, or give folder=None, so that nothing is kept"
            ) from error
        if isinstance(reduced, str):
            self._count_whole(str(getattr(value, "__module__", "")))
            return self._all("named", [reduced, kind])
        make, arguments, state, items, pairs, *_ = (*reduced, None, None, None, None)
        return self._all("object", [kind, make, arguments, state, list(items or ()), dict(pairs or ())])

    def _is_installed(self, module: ModuleType) -> bool:
        """True if a module is of mbsd, of Python or of an installed package; one of the user is noted."""
        name = module.__name__
        spec = getattr(module, "__spec__", None)
        file = file_of(module)
        if name != "__main__":
            built_in = file is None and getattr(spec, "origin", None) in ("built-in", "frozen")
            if built_in or (file is not None and _is_of_others(str(file))):
                self._installed(name)
                return True
            if file is None and hasattr(module, "__path__"):  # a package without a file of its own
                return all(_is_of_others(f"{place}/") for place in module.__path__)
        self.modules[name] = module
        return False

    def _installed(self, name: str) -> None:
        top = name.partition(".")[0]
        if top not in sys.stdlib_module_names and top not in ("mbsd", "builtins", "None", ""):
            self.packages.add(top)


def _is_bound(cell: types.CellType) -> bool:
    try:
        cell.cell_contents  # noqa: B018
    except ValueError:
        return False
    return True


@functools.cache
def _is_of_others(file: str) -> bool:
    return is_installed(file) or Path(file).is_relative_to(PACKAGE) or Path(file).resolve().is_relative_to(PACKAGE)


def _joined(kind: str, text: str, *parts: bytes) -> bytes:
    digest = hashlib.sha256(f"{kind} {len(text)} {len(parts)} {text}\0".encode(errors="surrogatepass"))
    for part in parts:
        digest.update(f"{len(part)} ".encode() + part)
    return digest.digest()


def _text(annotation: Any) -> str:
    return annotation if isinstance(annotation, str) else getattr(annotation, "__qualname__", str(annotation))


@functools.cache
def own_sources() -> str:
    """Return the SHA-256 over the sources of this package, by name and content."""
    digest = hashlib.sha256(mbsd.__version__.encode())
    for file in sorted(PACKAGE.rglob("*.py")):
        digest.update(file.relative_to(PACKAGE).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


GLOBAL = ("LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS")
IMPORTING = {"import_module", "__import__", "run_path", "run_module", "__subclasses__", "exec", "eval"}
"""Names with which code may reach modules that no import statement names."""
REFLECTIVE = {"__doc__", "getdoc", "getsource", "getsourcelines", "findsource", "_getframe", "currentframe"}
"""Names with which code may read its own source."""
READING = {"globals", "exec", "eval"}
"""Names with which code may reach globals that it does not name."""


class References(NamedTuple):
    """References of a code object and of those within it."""

    globals: frozenset[str]
    attributes: frozenset[str]
    """All names, globals among them."""
    imports: frozenset[tuple[str, int, tuple[str, ...]]]
    """Import statements: the module, its leading dots, the names taken from it."""

    @property
    def any_module(self) -> bool:
        """True if the code may reach any module that is loaded."""
        return bool(self.attributes & (IMPORTING | REFLECTIVE)) or {"sys", "modules"} <= self.attributes

    @property
    def any_global(self) -> bool:
        """True if the code may reach any global of its module."""
        return bool(self.globals & READING)


@cache
def references(code: CodeType) -> References:
    """Return the references of code."""
    named, imports = set[str](), set[tuple[str, int, tuple[str, ...]]]()
    before: list[object] = [0, None]
    for step in dis.get_instructions(code):
        if step.opname in GLOBAL:
            named.add(step.argval)
        elif step.opname == "IMPORT_NAME":
            level, taken = before
            imports.add(
                (step.argval, level if isinstance(level, int) else 0, taken if isinstance(taken, tuple) else ())
            )
        before = [before[1], step.argval]
    inner = [references(part) for part in code.co_consts if isinstance(part, CodeType)]
    return References(
        frozenset(named).union(*(part.globals for part in inner)),
        frozenset(code.co_names).union(*(part.attributes for part in inner)),
        frozenset(imports).union(*(part.imports for part in inner)),
    )


def instructions(code: CodeType) -> Iterator[tuple[str, object, bool]]:
    """Return the steps of code: name, argument, whether that is a constant.

    Left out are the line and the docstring of a class, which its body stores, and how constants are numbered, as a
    docstring is one.
    """
    steps = [step for step in dis.get_instructions(code) if step.opname != "EXTENDED_ARG"]
    for step, then in zip(steps, [*steps[1:], None], strict=True):
        if any(
            instruction is not None and instruction.opname == "STORE_NAME" and instruction.argval in _PLACES
            for instruction in (step, then)
        ):
            continue
        constant = step.opcode in dis.hasconst
        yield step.opname, step.argval if constant else (step.arg, step.argrepr), constant


_PLACES = ("__firstlineno__", "__doc__")
