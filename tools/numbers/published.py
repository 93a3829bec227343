"""The tests of published cases, run with an eye on what the solver gives them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import wraps
from pathlib import Path
from typing import Any

import pytest

from mbsd import Mechanism
from tools.numbers.digest import digest

TESTS = Path(__file__).resolve().parent.parent.parent / "tests"
FILES = "test_reference*.py"
ASKED = ("sweep", "simulate", "equilibrium", "linearise", "modes", "batch")


class _Watch:
    """Notes a hash of each call's result, under the name of the test and the number of the call."""

    def __init__(self) -> None:
        self.found: dict[str, str] = {}
        self._test, self._calls, self._depth = "", 0, 0

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        self._test, self._calls = f"published {item.path.stem.removeprefix('test_')} {item.name}", 0

    def watched(self, method: Callable[..., Any]) -> Callable[..., Any]:
        """The same method."""

        @wraps(method)
        def call(*arguments: Any, **options: Any) -> Any:
            self._depth += 1
            try:
                result = method(*arguments, **options)
            finally:
                self._depth -= 1
            if not self._depth:
                self._calls += 1
                self.found[f"{self._test} {self._calls}"] = digest(result)
            return result

        return call


def published(only: str) -> Iterator[tuple[str, str]]:
    """Name and hash of each call of the solver in these tests; of the files and tests that ``only`` names."""
    watch, kept = _Watch(), {name: getattr(Mechanism, name) for name in ASKED}
    for name, method in kept.items():
        setattr(Mechanism, name, watch.watched(method))
    try:
        files = [str(path) for path in sorted(TESTS.rglob(FILES))]
        arguments = ["-q", "--no-header", "--no-summary", "-p", "no:cacheprovider", "-p", "no:xdist", *files]
        words = re.findall(r"\w+", only.removeprefix("published"))
        if words:
            arguments += ["-k", " and ".join(words)]
        pytest.main(arguments, plugins=[watch])
    finally:
        for name, method in kept.items():
            setattr(Mechanism, name, method)
    yield from watch.found.items()
