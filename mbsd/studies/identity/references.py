"""References in the code of a function: global names, attributes, imports, and access by computed names."""

from __future__ import annotations

import dis
from collections.abc import Iterator
from functools import cache
from types import CodeType
from typing import NamedTuple

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
    """The steps of code: name, argument, whether that is a constant.

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
