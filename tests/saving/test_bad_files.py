"""Model files with something wrong in any field: refused with the file, or a model that solves; never a traceback."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, MechanismError, ModelError, constant_rate, curve, harmonic, polynomial, table
from mbsd.cams import Lift, flat_cam
from mbsd.saving.document import document

DEEP = "[" * 200 + "]" * 200


@cache
def _whole() -> dict[str, Any]:
    """A model with one of everything that has fields of its own."""
    m = Mechanism("whole")
    crank, rod, block = m.bar("crank", 0.1, 0.2), m.bar("rod", 0.3, 0.3), m.body("block", 0.5, inertia=0.1)
    m.revolute("O", m.ground.origin, crank.start, limits=(-9.0, 9.0))
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.origin)
    m.prismatic("guide", m.ground.at(0, 0), block.origin)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.spring("spring", m.ground.at(1.0, 0), block.origin, 5.0, damping=harmonic(0.1, 1.0, mean=1.0))
    m.torque("load", rod, polynomial(1.0, 0.5))
    m.motor("brake", m.ground, crank, curve([0, 1, 2], [3, 2, 0]))
    m.force("push", block.origin, table(np.linspace(-1, 9, 8), np.zeros(8)), direction=(1.0, 0.5))
    m.bushing("mount", m.ground.origin, rod.at(0.1, 0), (1.0, 2.0, 3.0))
    m.rigid_contact("floor", m.ground.at(0, -5.0), block.origin, restitution=0.5)
    m.trace("P", rod.at(0.1, 0.1))
    m.start_near(crank=20, block=(0.4, 0.0, 0.0))
    m.start_moving(crank=1.0)
    return document(m)


@cache
def _with_cam() -> dict[str, Any]:
    m = Mechanism("cam")
    m.cam_flat("cam", m.bar("disc", 0.1).origin, m.ground.origin, flat_cam(_lift(), 0.1))
    return document(m)


def _lift() -> Lift:
    return Lift.of((np.pi, 0.02, "cycloidal"), (np.pi, 0.0, "3-4-5"))


def _places(value: Any, path: tuple = ()) -> Iterator[tuple]:
    """Every key and index in a document."""
    for key, inside in (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    ):
        yield (*path, key)
        yield from _places(inside, (*path, key))


BAD = [
    "text",
    "1.0",
    "",
    None,
    True,
    [],
    [1, 2, 3],
    ["a", "b"],
    {},
    {"law": "harmonic"},
    {"body": "crank"},
    {"body": []},
]
BAD += [-1.0, 0, 1e-300, 1e300, 10**400, "@1e400", f"@{DEEP}", {"law": "polynomial", "coefficients": 3}]
BAD += [{"body": "crank", "x": "1", "y": 0, "angle": 0}, {"law": {"law": {"law": 1}}}, {"follower": "flat"}]


def _changed(written: dict[str, Any], path: tuple, bad: Any) -> str:
    """The text of the file with ``bad`` in one place; what begins with @ stands there as it is."""
    written = copy.deepcopy(written)
    inside = written
    for key in path[:-1]:
        inside = inside[key]
    inside[path[-1]] = "@@" if isinstance(bad, str) and bad.startswith("@") else bad
    text = json.dumps(written)
    return text.replace('"@@"', bad[1:]) if isinstance(bad, str) and bad.startswith("@") else text


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("model", [_whole, _with_cam])
def test_any_field_may_be_wrong(model: Callable[[], dict[str, Any]], tmp_path: Path) -> None:
    written, path = model(), tmp_path / "model.json"
    tries = [(place, bad) for place in _places(written) for bad in BAD]
    random = np.random.default_rng(5)
    accepted = []
    for k in random.choice(len(tries), min(len(tries), 350), replace=False):
        place, bad = tries[k]
        path.write_text(_changed(written, place, bad))
        what = f"{'.'.join(map(str, place))} = {str(bad)[:40]}"
        try:
            m = Mechanism.load(path)
        except ModelError as error:
            assert str(path) in str(error), what  # noqa: PT017
        except Exception as error:
            raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error
        else:
            number = isinstance(_value_of(written, place), int | float) and not isinstance(
                _value_of(written, place), bool
            )
            assert not (number and isinstance(bad, str | bool | list | dict)), f"{what} is accepted"
            accepted.append((what, m))
    for k in random.choice(len(accepted), min(len(accepted), 15), replace=False):
        what, m = accepted[k]
        try:
            m.sweep(0.1, steps=2)
        except MechanismError:
            continue
        except Exception as error:
            raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error


def _value_of(written: Any, place: tuple) -> Any:
    for key in place:
        written = written[key]
    return written


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[" * 100_000 + "]" * 100_000, "within each other more than 30 deep"),
        ('{"a": ' * 500 + "1" + "}" * 500, "within each other more than 30 deep"),
        ('{"name": 1e400}', "name is inf; every number must be finite"),
        ('{"name": ' + "9" * 5000 + "}", "not a whole JSON file"),
        ('{"name": "a", "name": "b"}', "two of the name 'name'"),
        ("", "not a whole JSON file"),
    ],
    ids=["lists", "objects", "infinite", "digits", "twins", "empty"],
)
def test_files_without_a_model_are_named(text: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    path.write_text(text)
    with pytest.raises(ModelError, match=says) as told:
        Mechanism.load(path)
    assert str(path) in str(told.value)
    assert len(str(told.value)) < 600
