"""Writer of numbers into mechanism.py, which checks that Params then has them.

The file as it would be is loaded first, in a process of its own: where a later line, a method of Params or a decorator
has the last word on a number, the literal would change and the mechanism would not.
"""

from __future__ import annotations

import ast
import asyncio
import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError
from shared.stage.paths import mechanism_file, shown_file, variant_of
from studio.live.processes.children import Child
from studio.live.processes.nursery import Nursery
from studio.live.writing.literals import literal, replaced
from studio.live.writing.overriding import deciding_line, written_line
from studio.live.writing.replacing import Meanwhile, content_of, replace

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
                f"line {line} {still}; nothing was written. Change it in that line, or take that line away"
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
