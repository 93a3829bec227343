"""What a class has for its users: fields with the strings below them, methods under the comments that group them."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from functools import cache, cached_property
from pathlib import Path
from typing import Any, NamedTuple

from shared.stage.paths import ROOT

GROUP = re.compile(r"^    # -- (.+?) -+$")


class Member(NamedTuple):
    """A field, property or method."""

    group: str
    name: str
    kind: str
    """field, property or method."""
    type: str
    doc: str
    value: Any


def members(owner: type) -> list[Member]:
    """Public ones in the order of their files, those of base classes first."""
    out: dict[str, Member] = {}
    for base in reversed(owner.__mro__):
        if base.__module__.startswith("mbsd."):
            out |= {member.name: member for member in _own(base)}
    return list(out.values())


def _own(owner: type) -> Iterator[Member]:
    for name, group, node, doc in _written(owner):
        if name.startswith("_"):
            continue
        value = inspect.getattr_static(owner, name, None)
        if isinstance(value, property | cached_property):
            back = (value.fget if isinstance(value, property) else value.func).__annotations__.get("return", "")
            yield Member(group, name, "property", str(back), inspect.getdoc(value) or "", value)
        elif isinstance(value, classmethod | staticmethod) or inspect.isfunction(value):
            plain = value.__func__ if isinstance(value, classmethod | staticmethod) else value
            yield Member(group, name, "method", "", inspect.getdoc(plain) or "", value)
        elif isinstance(node, ast.AnnAssign):
            yield Member(group, name, "field", ast.unparse(node.annotation), doc, value)


def _written(owner: type) -> Iterator[tuple[str, str, ast.stmt, str]]:
    """Name, group, statement and the string below it, of each name that the body of a class binds."""
    lines, start, body = _body(owner)
    groups = [(start + k, match[1]) for k, line in enumerate(lines) if (match := GROUP.match(line))]
    for node, after in zip(body, [*body[1:], None], strict=True):
        group = next((name for line, name in reversed(groups) if line < start + node.lineno - 1), "")
        for name in _names(node):
            yield name, group, node, _string(after)


@cache
def _body(owner: type) -> tuple[list[str], int, list[ast.stmt]]:
    lines, start = inspect.getsourcelines(owner)
    (tree,) = ast.parse(textwrap.dedent("".join(lines))).body
    assert isinstance(tree, ast.ClassDef)
    return lines, start, tree.body


def _names(node: ast.stmt) -> list[str]:
    if isinstance(node, ast.FunctionDef):
        return [node.name]
    targets = [node.target] if isinstance(node, ast.AnnAssign) else node.targets if isinstance(node, ast.Assign) else []
    return [target.id for target in targets if isinstance(target, ast.Name)]


def _string(node: ast.stmt | None) -> str:
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
        return inspect.cleandoc(node.value.value)
    return ""


def file_of(value: Any) -> str:
    """The file of a class or function, as in the clone."""
    return Path(inspect.getfile(inspect.unwrap(value))).relative_to(ROOT).as_posix()
