"""Names of the inputs that a user's code has, and the present state of each of them.

Whether anything has changed is known from names and states alone, without running that code. Python modules count by
the meaning of their code: comments, blank lines, line breaks and quotation marks do not count; every number, text,
operator and name does. Where source looks at itself (``__doc__``, inspect, line numbers), everything counts:
:func:`looks_at_itself`. Files that are read count by their bytes, folders by the names in them, packages by their
version. An input that was looked for and is missing counts too. Names of files below the root of a project are relative
to it, so that a copy elsewhere has the same names.
"""

from __future__ import annotations

import ast
import hashlib
import json
import os
import stat
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any

DYNAMIC = ("import_module", "__import__", "sys.modules", "runpy", "exec(", "eval(")
"""Words of source that may load modules unseen by its import statements."""
REFLECTIVE = (
    *("__doc__", "getdoc", "getcomments", "getsource", "findsource", "linecache", "tokenize", "lineno", "_getframe"),
    *("currentframe", "inspect.stack", "inspect.trace", "traceback", "doctest", "ast.parse"),
)
"""Words of source that may depend on docstrings, on the text of source, or on places in it."""
_DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


@lru_cache(maxsize=8192)
def meaning(source: bytes) -> str:
    """SHA-256 of what the source means; of its bytes where it is no Python."""
    try:
        tree = parsed(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return hashlib.sha256(b"no python\0" + source).hexdigest()
    return hashlib.sha256(repr(_flat(tree)).encode(errors="surrogatepass")).hexdigest()


@lru_cache(maxsize=4)
def parsed(source: bytes) -> ast.Module:
    """The syntax tree, which whoever looks at a file next needs as well. Raises what ``ast.parse`` does."""
    return ast.parse(source)


def looks_at_itself(source: bytes) -> bool:
    """True if code may depend on docstrings, comments or lines, its own or those of modules that it knows."""
    return any(word.encode() in source for word in REFLECTIVE)


def _flat(tree: ast.AST) -> list[Any]:
    """Kinds of nodes and values of the tree, in an order and with counts that leave only one tree."""
    out: list[Any] = []
    waiting: list[Any] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.AST):
            out.append(type(node).__name__)
            fields = [getattr(node, name, None) for name in node._fields if name != "type_comment"]
            if isinstance(node, _DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
                fields[fields.index(node.body)] = node.body[1:]
            if isinstance(node, ast.Constant):
                fields = [node.value]
            waiting.extend(fields)
        elif isinstance(node, list):
            out.append(len(node))
            waiting.extend(node)
        else:
            out += (type(node).__name__, node)
    return out


CHANGED = "changed meanwhile"
"""The state of an input that two runs saw in different states; nothing ever has it."""


@dataclass(kw_only=True)
class Inputs:
    """State of each input by its name; a state is a short text."""

    modules: dict[str, str] = field(default_factory=dict)
    """Python files that were loaded as modules."""
    files: dict[str, str] = field(default_factory=dict)
    folders: dict[str, str] = field(default_factory=dict)
    sources: dict[str, str] = field(default_factory=dict)
    """Folders of which all Python files count."""
    variables: dict[str, str] = field(default_factory=dict)
    """Variables of the environment."""
    packages: dict[str, str] = field(default_factory=dict)

    def states(self) -> dict[str, dict[str, str]]:
        """Names and states by kind of input."""
        return asdict(self)

    def names(self) -> dict[str, list[str]]:
        """Names by kind of input, without their states."""
        return {kind: sorted(states) for kind, states in self.states().items()}

    def digest(self) -> str:
        """SHA-256 over the states, and over those names that do not depend on where the project is."""
        rows = [
            (kind, "" if os.path.isabs(name) else name, state)
            for kind, states in self.states().items()
            for name, state in states.items()
        ]
        return hashlib.sha256(json.dumps(sorted(rows)).encode()).hexdigest()

    def joined(self, other: Inputs) -> Inputs:
        """Both together; where both have a name, the state of this one."""
        theirs = other.states()
        return Inputs(**{kind: theirs[kind] | states for kind, states in self.states().items()})

    def merged(self, other: Inputs) -> Inputs:
        """Both together; an input that they saw in different states is :data:`CHANGED`."""
        mine, theirs = self.states(), other.states()
        both = {
            kind: mine[kind]
            | {name: state if mine[kind].get(name, state) == state else CHANGED for name, state in states.items()}
            for kind, states in theirs.items()
        }
        return Inputs(**both)


class Places:
    """The place of a project, its folder ``root``: names of files, which of them count, and their states."""

    def __init__(self, root: Path) -> None:
        self._root = root

    @property
    def root(self) -> Path:
        """The folder relative to which files are named."""
        return self._root

    def name_of(self, path: str | os.PathLike[str]) -> str:
        """The name of a file: relative to the root, else absolute."""
        absolute = Path(os.path.abspath(path))
        return absolute.relative_to(self.root).as_posix() if absolute.is_relative_to(self.root) else absolute.as_posix()

    def path_of(self, name: str) -> Path:
        """Where the file with this name is."""
        return self.root / name

    def is_program(self, file: str) -> bool:
        """True if a source file belongs to the program, through which the user's code acts."""
        raise NotImplementedError

    def acts_for_itself(self, file: str) -> bool:
        """True if reads of this file of the program never count as the user's, whoever called it."""
        return False

    def observed(self, names: Any) -> Inputs | None:
        """Return the present states of inputs named by :meth:`Inputs.names`; None if ``names`` is malformed."""
        if not isinstance(names, dict) or set(names) != set(asdict(Inputs())):
            return None
        if not all(isinstance(listed, list) and all(isinstance(n, str) for n in listed) for listed in names.values()):
            return None
        return Inputs(**{kind: {name: self.state(kind, name) for name in names[kind]} for kind in names})

    def state(self, kind: str, name: str) -> str:
        """Return the present state of one input."""
        states: dict[str, Callable[[str], str]] = {
            "modules": self.module_state,
            "files": self.file_state,
            "folders": self.folder_state,
            "sources": self.sources_state,
            "variables": variable_state,
            "packages": self.package_state,
        }
        return states[kind](name)

    def module_state(self, name: str) -> str:
        """Hash of what a Python file means; its file's state where it is none that can be read."""
        path = self.path_of(name)
        try:
            return meaning(path.read_bytes()) if path.suffix == ".py" else self.file_state(name)
        except (OSError, ValueError):
            return self.file_state(name)

    def file_state(self, name: str) -> str:
        """SHA-256 of a file's content, or a word: missing, folder, special (a device or pipe), unreadable."""
        path = self.path_of(name)
        try:
            mode = os.stat(path).st_mode
            if stat.S_ISDIR(mode):
                return "folder"
            return self.hash_of(path) if stat.S_ISREG(mode) else "special"
        except (FileNotFoundError, NotADirectoryError):
            return "missing"
        except (OSError, ValueError):
            return "unreadable"

    def hash_of(self, path: Path) -> str:
        """SHA-256 of a file's bytes, as hex."""
        with path.open("rb") as handle:
            return hashlib.file_digest(handle, "sha256").hexdigest()

    def folder_state(self, name: str) -> str:
        """SHA-256 over the names in a folder, but for Python's caches; or missing, unreadable."""
        try:
            names = sorted(entry for entry in os.listdir(self.path_of(name)) if entry != "__pycache__")
        except (FileNotFoundError, NotADirectoryError):
            return "missing"
        except (OSError, ValueError):
            return "unreadable"
        return hashlib.sha256("\0".join(names).encode(errors="surrogateescape")).hexdigest()

    def sources_state(self, name: str) -> str:
        """SHA-256 over the Python files below a folder; or missing."""
        folder = self.path_of(name)
        if not folder.exists():
            return "missing"
        digest = hashlib.sha256()
        for file in sorted(folder.rglob("*.py")):
            digest.update(file.relative_to(folder).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
        return digest.hexdigest()

    def package_state(self, name: str) -> str:
        """The installed version, or missing."""
        return package_state(name)


def variable_state(name: str) -> str:
    """``=value`` of a variable of the environment, or nothing if it is not set."""
    value = os.environ.get(name)
    return "" if value is None else f"={value}"


def package_state(name: str) -> str:
    """The installed version, or missing."""
    try:
        return metadata.version(name)
    except (metadata.PackageNotFoundError, ValueError):
        return "missing"
