"""The motion of every mechanism in mechanisms/, as its film shows it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from shared.stage.paths import mechanism_names


def runs() -> Iterator[tuple[str, Callable[[], Any]]]:
    """By name."""
    for name in mechanism_names():
        yield f"gallery {name}", partial(_motion, name)


def _motion(name: str) -> Any:
    module, p = loading.load(name, "mechanism"), loading.params(name)
    return solving.motion_of(name, module, solving.build(name, module, p), p)
