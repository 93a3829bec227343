"""Writer of numbers into mechanism.py: it replaces literals, checks Params and loses no save."""

from __future__ import annotations

import ast
import asyncio
import ctypes
import math
import os
import re
import shutil
import stat
import sys
import time
import tokenize
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError
from shared.stage.files import refusal, whole_file
from shared.stage.paths import mechanism_file, shown_file, variant_of
from studio.live.numbers import parsed
from studio.live.processes.children import Child
from studio.live.processes.nursery import Nursery

# Numbers in the source of a mechanism.py: only the literal of each is replaced.
#
# A default of Params is a number, or a tuple of numbers at whose place it stands; ``field(default=...)`` is one, too. A
# default that is computed (``2 * pi``) is replaced as a whole. Of a variant, the numbers are those of VARIANTS.


LINES = re.compile(r"[^\r\n]*(?:\r\n|\r|\n)?")


def replaced(source: bytes, file: str, values: dict[str, float | int], variant: str | None = None) -> bytes:
    """Return the source with other numbers. Raises UserError; ``file`` is its name in errors."""
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError) as error:
        raise UserError(f"{file}: {error}; fix it first, then numbers can be written into it") from error
    encoding, _ = tokenize.detect_encoding(BytesIO(source.replace(b"\r", b"\n")).readline)
    text = source.decode(encoding)
    starts = _line_starts(text)
    lines = [text[a:b] for a, b in zip(starts, [*starts[1:], len(text)], strict=True)]

    def place(line: int, column: int) -> int:
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    edits = []
    for name, value in values.items():
        node = literal(tree, name, file, variant)
        end = place(node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)
        edits.append((place(node.lineno, node.col_offset), end, repr(value)))
    for first, last, new in sorted(edits, reverse=True):
        text = text[:first] + new + text[last:]
    ast.parse(text)
    return text.encode(encoding)


def _line_starts(text: str) -> list[int]:
    """Return the beginning of each line, as Python counts lines."""
    return [match.start() for match in LINES.finditer(text) if match[0]] or [0]


def literal(tree: ast.Module, name: str, file: str, variant: str | None) -> ast.expr:
    """Return the place of a number in the file. Raises UserError if it has none of its own."""
    field, places = parsed(name)
    node = _of_variant(tree, field, file, variant) if variant else _of_params(tree, field, file)
    for place in places:
        if not isinstance(node, ast.Tuple | ast.List) or place >= len(node.elts):
            raise UserError(
                f"{file}:{node.lineno}: {field} is computed, so {name} has no number of its own there; write its "
                "numbers out, as in (0.06, 0.03)"
            )
        node = node.elts[place]
    if isinstance(node, ast.Starred):
        raise UserError(f"{file}:{node.lineno}: {name} is one of *{ast.unparse(node.value)}; write its number out")
    return node


def _of_params(tree: ast.Module, field: str, file: str) -> ast.expr:
    for statement in tree.body:
        if isinstance(statement, ast.ClassDef) and statement.name == "Params":
            for line in statement.body:
                if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name) and line.target.id == field:
                    default = _default(line.value)
                    if default is not None:
                        return default
                    raise UserError(f"{file}:{line.lineno}: Params.{field} has no default of its own to replace")
    raise UserError(f"{file}: class Params does not define '{field}' itself; write its default there")


def _default(value: ast.expr | None) -> ast.expr | None:
    """Return the default, also of field(default=...)."""
    if isinstance(value, ast.Call) and isinstance(value.func, ast.Name | ast.Attribute):
        called = value.func.id if isinstance(value.func, ast.Name) else value.func.attr
        if called == "field":
            return next((keyword.value for keyword in value.keywords if keyword.arg == "default"), None)
    return value


def _of_variant(tree: ast.Module, field: str, file: str, variant: str) -> ast.expr:
    for statement in tree.body:
        targets = getattr(statement, "targets", [getattr(statement, "target", None)])
        value = getattr(statement, "value", None)
        if not any(isinstance(t, ast.Name) and t.id == "VARIANTS" for t in targets) or not isinstance(value, ast.Dict):
            continue
        inner = _of_key(value, variant)
        given = _of_key(inner, field) if isinstance(inner, ast.Dict) else None
        if given is not None:
            return given
    raise UserError(
        f"{file}: VARIANTS['{variant}'] does not replace '{field}', so writing it would change the mechanism itself; "
        f'add "{field}" there first, or open the mechanism'
    )


def _of_key(node: ast.Dict, wanted: str) -> ast.expr | None:
    pairs = zip(node.keys, node.values, strict=True)
    return next((value for key, value in pairs if isinstance(key, ast.Constant) and key.value == wanted), None)


# The later line of a mechanism.py that decides a number, so that its literal has no effect.


def written_line(source: bytes, name: str, file: str, variant: str | None) -> int:
    """Return the line of the literal of a number. Raises UserError if it has none."""
    return literal(ast.parse(source), name, file, variant).lineno


def deciding_line(source: bytes, name: str, file: str, variant: str | None) -> int | None:
    """Return the line after a number's literal that most likely decides it; None if none does.

    Looked for are, in this order, the field set again in the body of Params or in a method of it, Params or VARIANTS
    bound again, and what names the field in any other way.
    """
    tree = ast.parse(source)
    place = literal(tree, name, file, variant)
    field, _ = parsed(name)

    def last(inside: Iterable[ast.AST], decides: Callable[[ast.AST], bool]) -> int:
        """Return the last line after the literal in which a node decides it; 0 if there is none."""
        nodes = (node for tree in inside for node in ast.walk(tree))
        return max((_place(node)[0] for node in nodes if _is_after(node, place) and decides(node)), default=0)

    def names(node: ast.AST) -> bool:
        return _sets(node, field) or (isinstance(node, ast.Constant) and node.value == field)

    def binds(node: ast.AST) -> bool:
        if variant:
            return isinstance(node, ast.Name) and node.id == "VARIANTS"
        return _sets(node, "Params") or (isinstance(node, ast.ClassDef) and node.name == "Params")

    in_class = 0 if variant else last(_classes(tree), names)
    rest = (
        tree.body if variant else [line for line in tree.body if not any(_sets(n, "VARIANTS") for n in ast.walk(line))]
    )
    return in_class or last([tree], binds) or last(rest, names) or None


def _classes(tree: ast.Module) -> Iterator[ast.ClassDef]:
    return (node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "Params")


def _is_after(node: ast.AST, place: ast.expr) -> bool:
    return _place(node) >= (place.end_lineno or place.lineno, place.end_col_offset or place.col_offset)


def _place(node: ast.AST) -> tuple[int, int]:
    return getattr(node, "lineno", 0), getattr(node, "col_offset", 0)


def _sets(node: ast.AST, name: str) -> bool:
    """Return True if a node assigns a name, an attribute or a keyword of this name."""
    if isinstance(node, ast.Name | ast.Attribute):
        own = node.id if isinstance(node, ast.Name) else node.attr
        return own == name and not isinstance(node.ctx, ast.Load)
    return isinstance(node, ast.keyword) and node.arg == name


# Safe replacement of the author's file, only while it is unchanged: no save is lost.


AT_FDCWD, RENAME_EXCHANGE = -100, 2
"""Constants of Linux's <fcntl.h> and <linux/fs.h>."""
MOMENT = 0.05
"""Seconds in which an editor that had opened the old file before ends writing it."""


class Meanwhile(Exception):
    """Error for a file that has changed since it was read."""


def content_of(path: Path) -> bytes:
    """Return the content of a file of the author's. Raises UserError."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise UserError(refusal(path, error, "read")) from error


def replace(path: Path, before: bytes, after: bytes) -> None:
    """Write ``after`` into the file, whole, if it still has ``before``; mode and owner stay.

    The new file and the old one change places in one step where the system can; then what was taken out is looked at,
    and put back if an editor had saved meanwhile. Raises Meanwhile, and UserError where the file cannot be written.
    """
    try:
        status = path.stat()
    except OSError as error:
        raise UserError(refusal(path, error)) from error
    if not status.st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH) or not os.access(path, os.W_OK):
        raise UserError(f"{path.name} is read-only, so nothing is written into it: make it writable (chmod u+w {path})")

    def exchange(temporary: Path, target: Path) -> None:
        if content_of(target) != before:
            raise Meanwhile
        if not _exchanged(temporary, target):
            os.replace(temporary, target)
            return
        if temporary.read_bytes() == before:
            time.sleep(MOMENT)
            if temporary.read_bytes() == before:
                return
        _put_back(temporary, target, after)
        raise Meanwhile

    with whole_file(path, exchange) as temporary:
        temporary.write_bytes(after)
        temporary.chmod(stat.S_IMODE(status.st_mode))
        with suppress(OSError):
            shutil.chown(temporary, status.st_uid, status.st_gid)


def _put_back(temporary: Path, target: Path, after: bytes) -> None:
    """Restore an editor's save, unless there is a newer one."""
    if target.is_file() and target.read_bytes() == after:
        _exchanged(temporary, target)


def _exchanged(first: Path, second: Path) -> bool:
    """Exchange two files in one step; False where the system cannot."""
    rename = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None) if sys.platform == "linux" else None
    if rename is None:
        return False
    return rename(AT_FDCWD, os.fsencode(first), AT_FDCWD, os.fsencode(second), RENAME_EXCHANGE) == 0


# Writer of numbers into mechanism.py, which checks that Params then has them.
#
# The file as it would be is loaded first, in a process of its own: where a later line, a method of Params or a
# decorator has the last word on a number, the literal would change and the mechanism would not.


TRIES = 3
"""Contents of a file that an editor saves again and again."""
SHOWN = 60
"""Characters of an expression."""


@dataclass(frozen=True)
class Written:
    """Outcome of a write."""

    values: dict[str, float | int]
    text: str
    """For the page."""


class Writer:
    """Writer for one mechanism or variant; one request at a time."""

    def __init__(self, name: str, nursery: Nursery) -> None:
        self._name, self._nursery = name, nursery
        self._file = shown_file(name)
        self._task: asyncio.Task[None] | None = None
        self._child: Child | None = None

    def begin(
        self,
        values: dict[str, float | int],
        numbers: list[dict[str, Any]],
        done: Callable[[Written], None],
        refused: Callable[[str], None],
    ) -> None:
        """Write ``values``; ``numbers`` are those of the solved file.

        Raises UserError during another write.
        """
        if self._task is not None and not self._task.done():
            raise UserError("numbers are being written already; try again in a moment")

        async def work() -> None:
            try:
                done(await self._written(values, {number["name"]: number["value"] for number in numbers}))
            except UserError as error:
                refused(str(error))
            except Exception as error:
                refused(f"nothing was written into {self._file}: {error}")

        self._task = asyncio.get_running_loop().create_task(work())

    def end(self) -> None:
        """Stop writing."""
        if self._task is not None:
            self._task.cancel()
        if self._child is not None:
            self._child.kill()

    async def _written(self, values: dict[str, float | int], old: dict[str, float]) -> Written:
        variant = variant_of(self._name)
        for _ in range(TRIES):
            path = Path(os.path.realpath(mechanism_file(self._name)))
            before = await asyncio.to_thread(content_of, path)
            after = replaced(before, self._file, values, variant)
            words = [f"{', '.join(values)} written into {self._file}", *self._computed(before, values, variant)]
            if after != before:
                new = await self._numbers(after)
                self._check(after, values, new, variant)
                words += [
                    f"{name} is {new[name]:g} then (it was {old[name]:g}), for it is computed from others"
                    for name in new
                    if name in old and name not in values and not _same(new[name], old[name])
                ]
                try:
                    await asyncio.to_thread(replace, path, before, after)
                except Meanwhile:
                    continue
            return Written(values, "; ".join(words))
        raise UserError(
            f"{self._file} was saved {TRIES} times while numbers were being written into it, so nothing was written; "
            "try again"
        )

    def _check(self, after: bytes, values: dict[str, Any], new: dict[str, float], variant: str | None) -> None:
        """Raise UserError if a number would differ from the written one."""
        for name, value in values.items():
            if name in new and _same(new[name], value):
                continue
            line = written_line(after, name, self._file, variant)
            deciding = deciding_line(after, name, self._file, variant)
            where = f"line {deciding}" if deciding else "another line of the file, or a file it imports,"
            still = f"it would still be {new[name]:g}" if name in new else "there would be no such number"
            raise UserError(
                f"{self._file}:{deciding or line}: {name} cannot be written: {where} decides it, so with {value:g} in "
                f"line {line} {still}; nothing was written. Change it in that line, or delete that line"
            )

    def _computed(self, before: bytes, values: dict[str, Any], variant: str | None) -> list[str]:
        """Return sentences on expressions that a number replaces."""
        tree, computed = ast.parse(before), []
        for name in values:
            node = literal(tree, name, self._file, variant)
            try:
                ast.literal_eval(node)
            except ValueError:
                computed.append(f"{name} was {ast.unparse(node)[:SHOWN]} and is a number now")
        return computed

    async def _numbers(self, source: bytes) -> dict[str, float]:
        """Return the numbers of Params if the file held ``source``. Raises UserError."""
        answer: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()

        def heard(_: Child, header: dict[str, Any], __: bytes) -> None:
            if header.get("kind") in ("numbers", "error") and not answer.done():
                answer.set_result(header)

        self._child = self._nursery.child(self._name, heard)
        try:
            self._child.ask(0, {"do": "numbers"}, source)
            header = await answer
        finally:
            self._child.kill()
            self._child = None
        if header["kind"] == "error":
            raise UserError(f"nothing was written, for with these numbers the file cannot be loaded: {header['text']}")
        return {number["name"]: number["value"] for number in header["numbers"]}


def _same(first: float, second: float) -> bool:
    return math.isclose(first, second, rel_tol=1e-12, abs_tol=0.0)
