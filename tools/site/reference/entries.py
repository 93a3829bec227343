"""The section of a class or a function: how it is called, what it says of itself, what it has."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from itertools import groupby
from typing import Any

from tools.site.reference.members import Member, file_of, members
from tools.site.reference.words import first_sentence, signature, text

GIVEN_BACK = (
    "mbsd.results",
    "mbsd.analyses",
    "mbsd.kinematics",
    "mbsd.model",
    "mbsd.dynamics",
    "mbsd.drawing",
    "mbsd.pictures",
)
"""Rooms whose classes a call gives back: nobody makes one, so the table of their fields is enough."""
CALLED = {"Mechanism": "m.", "Solution": "sol."}
"""What the documents call one."""


def entry(name: str, value: Any, alone: bool = False) -> str:
    """The section; of a class that is ``alone`` on its page the page is the section."""
    if inspect.isclass(value):
        return _class(name, value, alone)
    words = code(signature(name, _plain(value)))
    return f"{heading('##', name)}\n\n{words}\n\n{text(inspect.getdoc(value))}\n\n{_source(value)}"


def heading(level: str, name: str, owner: str = "") -> str:
    """A heading whose anchor is the name as it is written: ``curve`` is not ``Curve``."""
    return f"{level} {name} {{ #{owner}{name} }}"


def code(words: str) -> str:
    """A block of Python."""
    return f"```python\n{words}\n```"


def _plain(value: Callable[..., Any]) -> Callable[..., Any]:
    """A kernel's Python."""
    return getattr(value, "py_func", value)


def _source(value: Any) -> str:
    try:
        return f"`{file_of(_plain(value))}`{{ .source }}\n"
    except (TypeError, ValueError, OSError):
        return ""


def _class(name: str, owner: type, alone: bool) -> str:
    parts = [] if alone else [heading("##", name)]
    if issubclass(owner, BaseException):
        parts += [f"A kind of `{owner.__mro__[1].__name__}`.", text(owner.__doc__)]
    else:
        made = [] if owner.__module__.startswith(GIVEN_BACK) else [code(f"class {_made(name, owner)}")]
        parts += [*made, text(owner.__doc__), _source(owner), *_members(name, owner, "##" if alone else "###")]
    return "\n\n".join(part for part in parts if part) + "\n"


def _made(name: str, owner: type) -> str:
    try:
        return signature(name, owner).removesuffix(" -> None")
    except (TypeError, ValueError):
        return name


def _members(name: str, owner: type, level: str) -> Iterator[str]:
    everything = members(owner)
    if data := [member for member in everything if member.kind != "method"]:
        yield _table(data)
    methods = [member for member in everything if member.kind == "method"]
    groups = [member.group for member in methods]
    for group, inside in groupby(sorted(methods, key=lambda member: groups.index(member.group)), lambda m: m.group):
        if group:
            yield f"{level} {group[0].upper()}{group[1:]} {{ #{name}-{group.partition(',')[0].replace(' ', '-')} }}"
        for member in inside:
            yield _method(name, member, level + "#" * bool(group))


def _table(data: list[Member]) -> str:
    rows = (f"| `{m.name}` | `{m.type}` | {first_sentence(m.doc)} |" for m in data)
    return "| name | type | what |\n|---|---|---|\n" + "\n".join(rows)


def _method(owner: str, member: Member, level: str) -> str:
    value = member.value.__func__ if isinstance(member.value, classmethod | staticmethod) else member.value
    words = code(CALLED.get(owner, "") + signature(member.name, value, not isinstance(member.value, staticmethod)))
    return f"{heading(level, member.name, f'{owner}.')}\n\n{words}\n\n{text(member.doc)}"
