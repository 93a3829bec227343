"""Loading of mechanism.py, parts.py and shot.py, their variants, and errors in an author's code."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import os
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from importlib.abc import MetaPathFinder
from importlib.machinery import (
    EXTENSION_SUFFIXES,
    SOURCE_SUFFIXES,
    ExtensionFileLoader,
    FileFinder,
    ModuleSpec,
    SourceFileLoader,
)
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType, FrameType, ModuleType
from typing import Any, Literal

from mechanisms.stages.loading.inputs import Inputs, is_installed, loaded_inputs, recording
from shared.stage.errors import UserError, did_you_mean
from shared.stage.paths import (
    MECHANISMS,
    NAME,
    NAME_RULE,
    RESERVED,
    ROOT,
    defines,
    in_workshop,
    is_single_file,
    mechanism_file,
    mechanism_folder,
    owner_of,
    shown_file,
    variant_of,
    variants_in,
)

# Says in a sentence what the author's code raised: the file, the author's own line, the error, a remedy if known.

OPERATIONS = {
    "fillet": "a fillet must be smaller than half of the narrowest web beside its edges: make it smaller, round fewer "
    "edges, or round them before the cuts that narrow the web",
    "chamfer": "a chamfer must be smaller than the faces beside its edges: make it smaller, or choose fewer edges",
    "shell": "a shell must be thinner than half of the narrowest wall: make it thinner",
    "cut": "the two solids may touch along a face or an edge only: move or enlarge the tool a little",
    "union": "the two solids may touch along an edge only: let them overlap",
    "revolve": "the profile must be closed and lie on one side of its axis",
    "extrude": "the outline must be closed and must not cross itself, and the height must not be 0",
}
"""CadQuery's operations that fail for geometry, with what to change."""
SHOWN = 3
"""Arguments of the failed operation that are quoted at most."""


def worded(
    error: BaseException, lines: Sequence[traceback.FrameSummary], shown: Callable[[Path], str] = Path.as_posix
) -> str:
    """``file:line: what was raised, in function(): the author's line``.

    ``lines`` are the author's, innermost last.

    ``lines`` are the author's, innermost last. For the CAD kernel's exceptions, which say no more than "command not
    done", the operation with its arguments, the line of ``parts()`` that led there and the remedy are added.
    """
    last = lines[-1]
    where = f"{shown(Path(last.filename))}:{last.lineno}"
    if isinstance(error, SystemExit):
        what = f"SystemExit: the file ends the program with exit({error.code if error.code is not None else ''})"
    else:
        what = f"{type(error).__name__}: {error}".rstrip(": ")
    within = f"in {last.name}(): " if last.name.isidentifier() else ""
    text = f"{where}: {what}" + (f", {within or 'at: '}{last.line}" if last.line else "")
    caller = next((line for line in lines if line.name == "parts" and line is not last), None)
    if caller is not None and caller.line:
        text += f" (from line {caller.lineno}: {caller.line.rstrip(',')})"
    from shared.shapes.kernel import is_of_kernel

    if not is_of_kernel(error):
        return text
    operation, arguments = _operation(error)
    if operation is None:
        return f"{text}. CadQuery could not make this shape: look for sizes that are zero, negative or too large"
    return f"{text}. CadQuery could not do {operation}({arguments}): {OPERATIONS[operation]}"


def _operation(error: BaseException) -> tuple[str | None, str]:
    """Return the outermost operation of :data:`OPERATIONS` in the traceback, and its numbers and texts as
    ``name=value``.
    """
    for frame, _ in traceback.walk_tb(error.__traceback__):
        if frame.f_code.co_name in OPERATIONS and "cadquery" in Path(frame.f_code.co_filename).parts:
            return frame.f_code.co_name, _arguments(frame)
    return None, ""


def _arguments(frame: FrameType) -> str:
    code = frame.f_code
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    plain = [(name, frame.f_locals.get(name)) for name in names]
    values = [f"{name}={value:g}" for name, value in plain if isinstance(value, int | float) and value is not True]
    return ", ".join(values[:SHOWN])


# Functions that an author writes for a stage: whether they take what the stage gives them.


def refuse_arguments(file: str, function: Callable[..., Any], *given: Any) -> None:
    """Raise UserError for a function of ``file`` that cannot be called so, as far as its signature says."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return
    try:
        signature.bind(*given)
    except TypeError as error:
        name = getattr(function, "__name__", "it")
        count = f"{len(given)} argument{'s' * (len(given) > 1)}"
        raise UserError(f"{file}: {name}({', '.join(signature.parameters)}) is called with {count}: {error}") from None


# Variants of a mechanism: ``VARIANTS = {"no_gravity": {"gravity": 0.0}}`` in mechanism.py, other values of Params.
#
# A variant is the same mechanism with some fields of its Params replaced; switches are fields that are True or False.
# ``DURATION`` and ``STEPS`` may be replaced as well. It is called by its mechanism's name and its own, has results of
# its own, and goes through all stages as a mechanism does.

CONSTANTS = ("DURATION", "STEPS")
"""Beside the fields of Params."""


def checked_variants(name: str, module: ModuleType) -> dict[str, dict[str, Any]]:
    """``VARIANTS`` of a mechanism.py; empty where there is none.

    Raises UserError naming the variant and the field.
    """
    file = shown_file(name)
    given = getattr(module, "VARIANTS", None)
    if given is None:
        return {}
    form = 'VARIANTS = {"no_gravity": {"gravity": 0.0}}'
    if not isinstance(given, Mapping) or not all(isinstance(values, Mapping) for values in given.values()):
        raise UserError(f"{file}: VARIANTS must be a dict of dicts by name, as in {form}")
    for variant in given:
        if not isinstance(variant, str) or not NAME.fullmatch(variant):
            raise UserError(f"{file}: {variant!r} cannot name a variant: {NAME_RULE}")
    known = variants_in(mechanism_file(name))
    if set(known) != set(given):
        raise UserError(
            f"{file}: VARIANTS must be written out with its names in quotes, as in {form}, so that they are known "
            "without running the file"
        )
    kind: Any = getattr(module, "Params", None)
    if given and not dataclasses.is_dataclass(kind):
        raise UserError(f"{file}: VARIANTS replace fields of Params, which must be a dataclass")
    fields = [field.name for field in dataclasses.fields(kind) if field.init]
    for variant, values in given.items():
        for field in values:
            if field not in (*fields, *CONSTANTS):
                raise UserError(
                    f"{file}: VARIANTS['{variant}'] has '{field}', which Params has not; it has: {', '.join(fields)}"
                    f"{did_you_mean(str(field), fields)}"
                )
    return {variant: dict(values) for variant, values in given.items()}


def replaced(name: str, module: ModuleType, p: Any) -> Any:
    """``p`` with the fields that the variant ``name`` replaces; ``p`` itself of a mechanism."""
    values = _values(name, module)
    fields = {field: value for field, value in values.items() if field not in CONSTANTS}
    return dataclasses.replace(p, **fields) if fields else p


def constant(name: str, module: Any, which: str) -> Any:
    """``DURATION`` or ``STEPS`` of a mechanism or variant; None where it is not said."""
    return _values(name, module).get(which, getattr(module, which, None))


def _values(name: str, module: Any) -> dict[str, Any]:
    variant = variant_of(name)
    return {} if variant is None else checked_variants(name, module)[variant]


# Loads one of the files of a mechanism; an error in it is reported with file and line.

File = Literal["mechanism", "parts", "shot", "tolerances"]
_RUNNING: ContextVar[str | None] = ContextVar("running", default=None)
"""The mechanism or variant whose author's code runs."""

REQUIRED: dict[File, dict[str, str]] = {
    "mechanism": {"Params": "a frozen dataclass of the lengths", "build": "def build(p: Params) -> Mechanism"},
    "parts": {"parts": "def parts(p: Params) -> dict[str, list[Solid]]"},
    "shot": {"shot": "shot = Shot(...)"},
    "tolerances": {"tolerances": "def tolerances(p: Params) -> dict[str, dict], as docs/tolerances.md shows"},
}


def load(name: str, file: File) -> ModuleType:
    """Import ``mechanisms/<name>/<file>.py``.

    Raises UserError, with file and line, when there is no such mechanism or file, when the file cannot be
    imported, or when it lacks what :data:`REQUIRED` lists.
    """
    path, owner = mechanism_file(name, file), owner_of(name)
    if not path.is_file():
        raise UserError(
            f"{owner}: {shown_file(name, file)} is missing; a mechanism has mechanism.py, and where it "
            "needs them, parts.py, shot.py and tolerances.py"
        )
    importlib.invalidate_caches()
    with author_code(name):
        module = importlib.import_module(f"mechanisms.{owner}.{'mechanism' if is_single_file(name) else file}")
    for attribute, form in REQUIRED[file].items():
        if not hasattr(module, attribute):
            raise UserError(f"{owner}: {shown_file(name, file)} does not define '{attribute}'; write {form}")
    return module


def params(name: str) -> Any:
    """``Params()`` of a mechanism, or what a variant makes of them. Raises UserError as :func:`load`."""
    module = load(name, "mechanism")
    kind: Any = module.Params
    if dataclasses.is_dataclass(kind):
        for field in dataclasses.fields(kind):
            if field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
                raise UserError(
                    f"{_shown(Path(str(module.__file__)))}: Params.{field.name} has no default; give it one"
                )
    checked_variants(name, module)
    with author_code(name):
        return replaced(name, module, module.Params())


def package_of(name: str) -> str:
    """Return the Python package of a mechanism's files, which its variants share."""
    return f"mechanisms.{owner_of(name)}"


def has(name: str, file: File) -> bool:
    """Return True if a mechanism has this file; parts.py and shot.py may be left out."""
    path = mechanism_file(name, file)
    return defines(path, file) if file != "mechanism" and is_single_file(name) else path.is_file()


def recorded[Result](
    name: str, make: Callable[[], Result], files: Sequence[File] = ("mechanism",), solver: bool = False
) -> tuple[Result, Inputs]:
    """Return what ``make`` returns, and what the author's ``files`` that run in it are made of and read.

    The solver as a whole is among these only if asked for: for stages that solve it counts anyway.
    """
    before = set(sys.modules)
    with recording() as recorder:
        made = make()
    inputs = recorder.inputs()
    for file in files:
        loaded = loaded_inputs(mechanism_file(name, file), package_of(name), before)
        if not solver:
            loaded.sources.pop("mbsd", None)
        inputs = loaded.joined(inputs)
    return made, inputs


@contextmanager
def author_code(name: str) -> Iterator[None]:
    """Turn what the author's code raises into a UserError that names file, line and the line's text.

    A UserError passes as it is. An exception that comes from elsewhere without touching the mechanism's folder
    is a fault of ours and passes too; ``MBSD_TRACEBACK=1`` shows the traceback of either (shared/stage/console.py).
    """
    folder = _folder_of(name)
    token = _RUNNING.set(name)
    try:
        yield
    except UserError:
        raise
    except SyntaxError as error:
        if not error.filename or not _is_below(error.filename, folder):
            raise
        shown = f"{_shown(Path(error.filename))}:{error.lineno}"
        raise UserError(f"{shown}: {error.msg}: {(error.text or '').strip()}") from error
    except (Exception, SystemExit) as error:
        lines = [frame for frame in traceback.extract_tb(error.__traceback__) if _is_below(frame.filename, folder)]
        if not lines:
            raise
        raise UserError(worded(error, lines, _shown)) from error
    finally:
        _RUNNING.reset(token)


def _folder_of(name: str) -> Path:
    """Return the folder of a mechanism; on a cluster's worker, which lacks it, where it would be."""
    try:
        return mechanism_folder(name) if in_workshop() else MECHANISMS / owner_of(name)
    except UserError:
        return MECHANISMS / owner_of(name)


def running(folder: str) -> str:
    """Return the name of a folder's mechanism, or of its variant whose files are running just now."""
    name = _RUNNING.get()
    return name if name is not None and owner_of(name) == folder else folder


INSTEAD: dict[str, bytes] = {}
"""Sources that are loaded in place of a file's, by its real path, to learn what they would be."""


class _SourceOnly(SourceFileLoader):
    """Compiles the file each time: Python's own cache misses an edit within a second that keeps the size."""

    def get_code(self, fullname: str) -> CodeType:
        source = INSTEAD.get(os.path.realpath(self.path)) if INSTEAD else None
        return self.source_to_code(self.get_data(self.path) if source is None else source, self.path)


def _author_folder(path: str) -> FileFinder:
    """Find, as a path hook, modules in the author's folders below a mechanism or outside the project.

    Raises ImportError for the program's own folders, those of installed packages and the standard library.
    """
    place = Path(os.path.abspath(path))
    if in_workshop() and place.is_relative_to(MECHANISMS):
        ours = _is_programs(str(place))
    elif place.is_relative_to(MECHANISMS):
        folder = place.relative_to(MECHANISMS).parts[:1]
        ours = not folder or not (MECHANISMS / folder[0] / "mechanism.py").is_file()
    else:
        ours = place.is_relative_to(ROOT) or is_installed(f"{place}{os.sep}")
    if ours or not place.is_dir():
        raise ImportError(f"{path} holds none of the author's files")
    return FileFinder(path, (ExtensionFileLoader, EXTENSION_SUFFIXES), (_SourceOnly, SOURCE_SUFFIXES))


def _is_below(filename: str, folder: Path) -> bool:
    return Path(filename).is_relative_to(folder) and not (in_workshop() and _is_programs(filename))


def _is_programs(place: str) -> bool:
    """Return True if a place in a user's folder belongs to an environment or to the program."""
    own = MECHANISMS.is_relative_to(ROOT)
    return is_installed(f"{place}{os.sep}") or (not own and Path(place).is_relative_to(ROOT))


def _shown(path: Path) -> str:
    return path.relative_to(MECHANISMS if in_workshop() else MECHANISMS.parent).as_posix()


class _Machines(MetaPathFinder):
    """Finds machines of a user's own folder as packages, though they may be files or that folder."""

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> ModuleSpec | None:
        top, _, rest = fullname.partition(".")
        owner, _, file = rest.partition(".")
        if top != "mechanisms" or not owner or owner in RESERVED or not in_workshop() or "." in file:
            return None
        try:
            source = mechanism_file(owner)
            single = is_single_file(owner)
        except UserError:
            return None
        if not file:
            return self._package(fullname, source.parent, single)
        if file == "mechanism" and single:
            return spec_from_file_location(fullname, source, loader=_SourceOnly(fullname, str(source)))
        return None

    def _package(self, fullname: str, folder: Path, single: bool) -> ModuleSpec:
        init = folder / "__init__.py"
        if not single and init.is_file():
            loader = _SourceOnly(fullname, str(init))
            spec = spec_from_file_location(fullname, init, loader=loader, submodule_search_locations=[str(folder)])
            assert spec is not None
            return spec
        package = ModuleSpec(fullname, None, is_package=True)
        package.submodule_search_locations = [str(folder)]
        return package


sys.path_hooks.insert(0, _author_folder)
if in_workshop():
    sys.meta_path.insert(0, _Machines())
    sys.path.append(str(MECHANISMS))  # a machine may import what lies beside it; last, so that it hides no room
