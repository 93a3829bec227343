"""Where machine code is kept between runs: in folders named after what a kernel is made of.

numba's own cache does not notice an edit in an *imported* file (numba issue 9483): a caller would silently keep the
old numbers. So each kernel's folder is named after a hash of its file and of all that this file imports at its top,
files of installed packages left out. An edit that no kernel is made of compiles nothing anew; going back to
an earlier source finds its code again.

A wheel may bring compiled code along, in ``mbsd/kernels``, and a clone that another user owns has its own. Both are
looked at first; what they lack is looked for, compiled and kept in the user's folder. How files are written, and what
becomes of damaged ones, is in ``kernel_files.py``.
"""

from __future__ import annotations

import hashlib
import importlib
import logging
import os
import re
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, cached_property, lru_cache
from pathlib import Path
from typing import Any

from numba.core.caching import CompileResultCacheImpl, FunctionCache, _Cache, _CacheLocator

from mbsd.compiling.alternatives import files_added, kernel_for
from mbsd.compiling.kernel_files import SHIPPED, KernelFiles, tell_of_other_kernels
from mbsd.compiling.kernel_library import Apart
from mbsd.compiling.lazy_kernel import cell_of

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

LOG = logging.getLogger("mbsd")
_PACKAGE = Path(__file__).parent.parent
_HERE = _PACKAGE.parent
_ABOUT_THE_CACHE = {str(_PACKAGE / "compiling" / name) for name in ("kernel_cache.py", "kernel_files.py", "notice.py")}
"""Files that decide where code is kept and what is said, not what it does."""
KEPT = 4
"""Number of versions of one file's kernels that are kept."""

_IMPORT = re.compile(r"^(?:from\s+([\w.]+)\s+import\s+(\([^)]*\)|[^\n]*)|import\s+([^\n]*))", re.MULTILINE)


@lru_cache(maxsize=1)
def cache_root() -> Path:
    """Return the first writable folder for compiled kernels.

    Candidates are numba's NUMBA_CACHE_DIR if set, the folder beside the package, the user's cache, and a temporary
    folder of the user's own.
    """
    for parent in _parents():
        folder = parent / "kernels"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
            return folder
        except OSError:
            continue
    raise OSError("no folder is writable for compiled code; set XDG_CACHE_HOME to one that is")


def _parents() -> Iterator[Path]:
    """Yield folders that may be writable, the best first."""
    given, user_cache = os.environ.get("NUMBA_CACHE_DIR"), os.environ.get("XDG_CACHE_HOME")
    if given:
        yield Path(given)
    yield _beside_package()
    if not user_cache:
        with suppress(RuntimeError):  # a user whom the system knows by number alone, as in a container, has no home
            user_cache = Path.home() / ".cache"
    if user_cache:
        yield Path(user_cache) / "mbsd"
    if (own := _own_temporary()) is not None:
        yield own


def _beside_package() -> Path:
    return _PACKAGE / "__pycache__"


def _folders_to_read() -> tuple[Path, ...]:
    """Return folders of others' kernels that are read before the user's own.

    They are the wheel's, and those of a clone that this user cannot write to.
    """
    clones = _beside_package() / "kernels"
    others = () if os.environ.get("NUMBA_CACHE_DIR") or clones == cache_root() else (clones,)
    return tuple(folder for folder in (SHIPPED, *others) if folder.is_dir())


def _own_temporary() -> Path | None:
    """Return a temporary folder that nobody else can write to, since its files are run.

    It is None if others have made it.
    """
    user = os.getuid() if hasattr(os, "getuid") else None  # Windows has a temporary folder for each user
    try:
        folder = Path(tempfile.gettempdir()) / ("mbsd" if user is None else f"mbsd-{user}")
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
    except OSError:
        return None
    alone = stat.S_ISDIR(status.st_mode) and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return folder if user is None or (status.st_uid == user and alone) else None


@cache
def _read(path: str) -> tuple[bytes, tuple[tuple[str, tuple[str, ...]], ...]]:
    """Return the hash of a source file and its imports: modules, each with the names taken from it.

    Only imports at the top count.
    """
    source = Path(path).read_bytes()
    imports: list[tuple[str, tuple[str, ...]]] = []
    for match in _IMPORT.finditer(source.decode()):
        base, members, plain = match.groups()
        if base:
            imports.append((base, tuple(re.findall(r"\w+", re.sub(r"\bas\s+\w+|#.*", "", members)))))
        else:
            imports += [(name.split()[0], ()) for name in plain.split(",") if name.split()]
    return hashlib.sha256(source).digest(), tuple(imports)


def _sources(path: str) -> Iterator[str]:
    """Yield the file of a kernel and all it imports, of this package and from beside that file."""
    waiting, seen, within = [path], {path}, (str(_PACKAGE) + os.sep, str(Path(path).parent) + os.sep)
    while waiting:
        current = waiting.pop()
        yield current
        for base, members in _read(current)[1]:
            modules = [f"{base}.{name}" for name in members if f"{base}.{name}" in sys.modules]
            if len(modules) < max(1, len(members)):  # a package that only modules are taken from gives no value itself
                modules.append(base)
            for name in modules:
                file = getattr(sys.modules.get(name), "__file__", None)
                if file and file not in seen and file.startswith(within) and file not in _ABOUT_THE_CACHE:
                    seen.add(file)
                    waiting.append(file)


@cache
def made_of(path: str) -> str:
    """Return a hash of all sources that the kernels of a file are made of."""
    digest = hashlib.sha256()
    for source in sorted(_sources(path), key=_name):
        digest.update(_name(source).encode() + b"\0" + _read(source)[0])
    return digest.hexdigest()[:16]


def _name(path: str) -> str:
    """Return a path that is the same on every machine, for files of the package."""
    return Path(path).relative_to(_HERE).as_posix() if path.startswith(str(_PACKAGE) + os.sep) else path


class _Locator(_CacheLocator):
    """Says where numba keeps the code of one function."""

    def __init__(self, py_func: Callable[..., Any], py_file: str, root: Path, added: tuple[str, ...] = ()) -> None:
        """Place the code of a function; ``added`` kernels of other classes have a folder of their own,
        as numba's index cannot be read where such a class is missing.
        """
        self._line = py_func.__code__.co_firstlineno
        self._stamp = made_of(py_file)
        if added:
            self._stamp = hashlib.sha256("".join([self._stamp, *map(made_of, added)]).encode()).hexdigest()[:16]
        name = _name(py_file).removesuffix(".py").strip(os.sep).replace(os.sep, ".").replace("/", ".")
        name += "+" if added else ""
        self._path = str(root / f"{name[-80:]}-{self._stamp}")

    def get_cache_path(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Return the folder."""
        return self._path

    def get_source_stamp(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Return the hash of all that the code is made of."""
        return self._stamp

    def get_disambiguator(self) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Return the line of a function, by which functions of one name in one file differ."""
        return str(self._line)

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> _Locator | None:
        """Return the locator; None for functions without a file, such as those of a notebook."""
        if not os.path.isfile(py_file):
            return None
        return cls._with_folder(cls(py_func, py_file, cache_root()))

    @staticmethod
    def _with_folder(made: _Locator) -> _Locator:
        """Return the locator after making its folder, and remove folders of older versions."""
        folder = Path(made._path)
        if not folder.is_dir():
            folder.mkdir(parents=True, exist_ok=True)
            _forget_old(folder)
        return made


class _LocatorOfAdded:
    """Says where the code of a function for classes that were added is."""

    def __init__(self, added: tuple[str, ...]) -> None:
        self.added = added

    def from_function(self, py_func: Callable[..., Any], py_file: str) -> _Locator | None:
        """Return the locator; None for functions without a file."""
        if not os.path.isfile(py_file):
            return None
        return _Locator._with_folder(_Locator(py_func, py_file, cache_root(), self.added))


class _LocatorToRead:
    """Says where the code of a function is in a folder that is only read."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def from_function(self, py_func: Callable[..., Any], py_file: str) -> _Locator | None:
        """Return the locator; None where the folder has nothing of that file as it is."""
        locator = _Locator(py_func, py_file, self.root) if os.path.isfile(py_file) else None
        return locator if locator is not None and os.path.isdir(locator.get_cache_path()) else None


def _forget_old(folder: Path) -> None:
    """Remove all but the newest versions of what is kept in ``folder``."""
    same = [version for version in folder.parent.glob(f"{folder.name[:-16]}*") if len(version.name) == len(folder.name)]
    times = []
    for version in same:
        try:
            times.append((version.stat().st_mtime, version))
        except OSError:
            continue
    for _, old in sorted(times, reverse=True)[KEPT:]:
        shutil.rmtree(old, ignore_errors=True)


class _Results(CompileResultCacheImpl):
    """With the kernels that one calls and that stand apart: they are loaded before it."""

    _locator_classes = [_Locator, *CompileResultCacheImpl._locator_classes[-2:]]  # numba's for notebooks and archives

    def reduce(self, cres: Any) -> Any:
        """Return what is written."""
        library = cres.library
        called = {name: (*_place(call.dispatcher), call.arguments) for name, call in library.calls.items()}
        cells = [(*_place(cell.dispatcher), cell.arguments, cell.returns) for cell in library.cells.values()]
        own = super().reduce(cres)
        if library.only_linked:
            own = (*own[:-1], ())  # places in machine code, of which there is none
        return called, cells, own

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """Return the compiled function from what was read."""
        called, cells, own = payload
        calls = {}
        made = [
            cell_of(
                kernel_for(getattr(importlib.import_module(module), function), arguments).kernel, arguments, returns
            )
            for module, function, arguments, returns in cells
        ]
        for name, (module, function, arguments) in called.items():
            calls[name] = Apart(name, _kernel_named(module, function), arguments)
            if calls[name].library is None:
                return None
        cres = super().rebuild(target_context, own)
        cres.library.calls = calls
        cres.library.cells = {cell.name: cell for cell in made}
        return cres


def _place(dispatcher: Any) -> tuple[str, str]:
    """Return module and name of a kernel."""
    return dispatcher.py_func.__module__, dispatcher.py_func.__qualname__


def _kernel_named(module: str, function: str) -> Any:
    """Return the kernel at the module and name that ``_place`` gives."""
    return getattr(importlib.import_module(module), function)


class _Files(FunctionCache):
    """numba's cache of one function, with our files; in ``root``, which is only read, if that is given."""

    _impl_class = _Results

    def __init__(self, py_func: Callable[..., Any], root: Path | None = None, added: tuple[str, ...] = ()) -> None:
        if root is not None:
            self._impl_class = type("_ResultsToRead", (_Results,), {"_locator_classes": [_LocatorToRead(root)]})
        elif added:
            self._impl_class = type("_ResultsOfAdded", (_Results,), {"_locator_classes": [_LocatorOfAdded(added)]})
        super().__init__(py_func)
        locator = self._impl.locator
        self._cache_file = KernelFiles(locator.get_cache_path(), self._impl.filename_base, locator.get_source_stamp())


@contextmanager
def _alone_in(folder: str) -> Iterator[None]:
    """Lock ``folder`` against other processes: numba would give two signatures the same file."""
    if fcntl is None:
        yield
        return
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, ".lock"), "ab") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        yield


@cache
def _tell_of_full_disk(folder: str, reason: str) -> None:
    """Log, once, that compiled code cannot be kept."""
    LOG.warning("mbsd: compiled code cannot be kept in %s (%s), so the next run compiles again", folder, reason)


class KernelCache(_Cache):
    """Cache of one function, opened when it is first compiled: by then all its imports are loaded."""

    def __init__(self, py_func: Callable[..., Any]) -> None:
        self._py_func = py_func
        self._enabled = True
        self._added: dict[tuple[str, ...], _Files | None] = {}

    @cached_property
    def _files(self) -> _Files | None:
        try:
            return _Files(self._py_func)
        except (RuntimeError, OSError):  # no place for it: compiled in every process
            return None

    @cached_property
    def _to_read(self) -> list[_Files]:
        caches = []
        for folder in _folders_to_read():
            with suppress(RuntimeError, OSError):
                caches.append(_Files(self._py_func, folder))
        return caches

    def _of_added(self, added: tuple[str, ...]) -> _Files | None:
        """Return the files of code for classes that were added; None without a place for them."""
        if added not in self._added:
            try:
                self._added[added] = _Files(self._py_func, added=added)
            except (RuntimeError, OSError):
                self._added[added] = None
        return self._added[added]

    @property
    def cache_path(self) -> str | None:  # pyright: ignore[reportIncompatibleMethodOverride, reportIncompatibleVariableOverride]
        """The folder, if there is one."""
        return None if self._files is None else self._files.cache_path

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled function, or None."""
        if not self._enabled:
            return None
        if added := files_added(sig):
            own = self._of_added(added)
            return None if own is None else own.load_overload(sig, target_context)
        overload = None
        for files in (*self._to_read, self._files):
            if overload is None and files is not None:
                overload = files.load_overload(sig, target_context)
        if overload is None and SHIPPED.is_dir():
            tell_of_other_kernels()
        return overload

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled function, where the disk takes it."""
        if not self._enabled:
            return
        added = files_added(sig)
        files = self._of_added(added) if added else self._files
        if files is None:
            return
        try:
            with _alone_in(files.cache_path):
                files.save_overload(sig, data)
        except OSError as error:
            _tell_of_full_disk(str(cache_root()), error.strerror or str(error))

    def enable(self) -> None:
        """Do nothing: the cache is always on."""
        self._enabled = True

    def disable(self) -> None:
        """Compile in every process."""
        self._enabled = False

    def flush(self) -> None:
        """Do nothing: what is kept stays."""
        if self._files is not None:
            self._files.flush()
