"""Runs of the gallery, and of the tests of published cases with an eye on what the solver gives them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial, wraps
from pathlib import Path
from typing import Any

import pytest

from mbsd import Mechanism
from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from shared.stage.paths import planar_names

# The tests of published cases, run with an eye on what the solver gives them.


TESTS = Path(__file__).resolve().parent.parent.parent / "tests"
FILES = "test_reference*.py"
ASKED = ("sweep", "simulate", "equilibrium", "linearise", "modes", "batch")


class _Watch:
    """Notes of what ``measure`` makes of each call's result, by the test and the number of the call."""

    def __init__(self, measure: Callable[[Any], Any]) -> None:
        self.noted: dict[str, Any] = {}
        self._measure = measure
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
                self.noted[f"{self._test} {self._calls}"] = self._measure(result)
            return result

        return call


def published(only: str, measure: Callable[[Any], Any]) -> Iterator[tuple[str, Any]]:
    """Yield the name of each call of the solver in the tests that ``only`` names, and its measure."""
    watch, kept = _Watch(measure), {name: getattr(Mechanism, name) for name in ASKED}
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
    yield from watch.noted.items()


# The motion of every mechanism in mechanisms/, as its film shows it.


def runs() -> Iterator[tuple[str, Callable[[], Any]]]:
    """By name."""
    for name in planar_names():
        yield f"gallery {name}", partial(_motion, name)


def _motion(name: str) -> Any:
    module, p = loading.load(name, "mechanism"), loading.params(name)
    return solving.motion_of(name, module, solving.build(name, module, p), p)
