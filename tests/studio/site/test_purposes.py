"""Filters of the wall: found in what a machine says of itself and in its kinds."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from studio.site.entries import filters, neighbours, purposes


def motion(*kinds: str) -> Any:
    joints = {str(k): SimpleNamespace(kind=kind) for k, kind in enumerate(kinds)}
    return SimpleNamespace(joints=joints, drivers={}, forces={}, contacts={})


def test_words_and_kinds_give_purposes() -> None:
    said = "A leg that walks on the ground. A spring holds it."
    assert purposes("beach_leg", said, motion("revolute", "gear_pair")) == ["walks", "gears"]
    assert purposes("press", "It presses a block.", motion("revolute")) == ["clamps and presses"]
    assert purposes("v8", "An engine of eight cylinders.", motion("revolute")) == ["engines"]
    assert purposes("plain", "A linkage.", motion("revolute")) == []


def test_a_filter_has_two_machines_and_the_most_common_comes_first() -> None:
    of = {"a": ["gears", "walks"], "b": ["gears"], "c": ["gears", "lifts"], "d": ["lifts"]}
    assert filters(of) == ["gears", "lifts"]


def test_neighbours_share_most_and_none_is_its_own() -> None:
    of = {"a": ["gears", "lifts"], "b": ["gears"], "c": ["gears", "lifts"], "d": ["walks"], "e": []}
    assert neighbours("a", of, 2) == ["c", "b"]
    assert "a" not in neighbours("a", of, 9)
