"""Whatever is changed, the model is the one that would have been built with these numbers: packed arrays and file."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, circle, constant_rate, curve, harmonic, pressure_table, two_stroke
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.model import plane_curves
from mbsd.model.change import Role, arguments
from mbsd.model.joint import CONTACT_KINDS
from mbsd.saving.document import build, document
from mbsd.testing import force_kinds, joint_kinds

KINDS = [*joint_kinds(), *force_kinds(), *CONTACT_KINDS.values()]
WAVY = [(-6, -3), (-4, -2.6), (-2, -2), (0, -2.2), (2, -2.5), (4, -1.9), (6, -1.9)]
LIFT = {"segments": [[math.pi, 0.15, "cycloidal"], [math.pi, 0.0, "3-4-5"]], "start": 0.0}


def _another_push(t: Any, q: Any, v: Any) -> Any:
    return 1.0 - q[0], 0.3 * v[1], 0.1 * t


def _another_law(x: Any, rate: Any) -> Any:
    return 2.0 - x - 0.1 * rate


def _another_constraint(x: Any, y: Any, a: Any) -> Any:
    return x * x + 0.5 * y * y - 1.0 + 0.2 * a


OTHERS: dict[str, list[Any]] = {
    "joint": ["other"],
    "points": [WAVY],
    "slots": [7],
    "module": [0.02, None],
    "pitch": [0.03, None],
    "phase": [(0.2, 0.4), None],
    "together": [(0.2, 0.4), None],
    "turns": [1, 2],
    "limits": [(-2.0, 1.5), (None, 3.0), None],
    "of_angle": [curve([-2.0, 0.0, 2.0], [1.0, 0.5, -3.0]), None],
    "of_length": [curve([0.1, 1.0, 5.0], [1.0, 0.5, -3.0]), None],
    "of_rate": [curve([-2.0, 0.0, 2.0], [3.0, 0.0, -1.0]), None],
    "profile": [
        curve([-5.0, -1.0, 2.0, 5.0], [0.1, 0.2, -0.1, 0.0]),
        {"follower": "flat", "lift": LIFT, "base_radius": 1.2},
        {"follower": "roller", "lift": LIFT, "base_radius": 1.2, "roller_radius": 0.2, "offset": 0.0},
        None,
    ],
    "function": [_another_push, _another_constraint],
    "unit": ["rad"],
    "crank": ["first", "third"],
    "cycle": [two_stroke(7.0, heat=3.0), pressure_table([0.0, 1.0, 2.0, 9.0], [1e5, 3e5, 2e5, 1e5])],
    "length": [0.37, 1.4, 5.0],
    "rod": [14.0, None, 0.03],
    "supply": [5e4],
    "breaks": [(0.5, 1.5)],
    "shortest": [0.01, None],
    "direction": [(0.3, -0.4), 1.2],
    "centre": [(0.1, 0.7)],
    "wind": [(3.0, 0.5)],
    "teeth": [(20, 11), 17, None],
    "law": [constant_rate(2.0, 0.1), _another_law],
    "stiffness": [77.0, (50.0, 60.0, 2.0), harmonic(3.0, 2.0, 0.0, 10.0)],
    "damping": [0.5, (1.0, 0.5, 0.2)],
    "restitution": [0.6],
    "clearance": [0.01, 0.1],
    "slip_speeds": [(0.0, 0.5), (0.2, 3.0)],
    "start": [(0.01, 0.02), (0.0, 0.0), 1e-4],
    "backlash": [1e-3, 0.01],
    "bore": [0.2, 0.05],
    "damping_model": ["lankarani_nikravesh"],
    "static_friction": [0.9, None],
    "static": [0.9, None],
    "slip_speed": [0.05, None],
    "exponent": [2.0],
    "radius": [0.17, None],
    "radius_i": [0.6, None],
    "radius_j": [0.15, None],
    "outline_i": [circle(29.0, (-30.0, 0.1))],
    "outline_j": [circle(0.6, (0.2, 0.1)), [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.2)]],
    "runs": [[0]],
    "friction": [0.6, 0.1, 0.0],
    "coefficient": [0.8, 0.1],
}
"""Values for arguments by name; what a kind refuses, it must refuse in both ways."""


@pytest.fixture(autouse=True)
def _curves_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Check each curve once: that takes a quarter of a second, and curves are built hundreds of times."""
    for name in ("check_crossing", "check_curvature"):
        monkeypatch.setattr(plane_curves, name, _once(getattr(plane_curves, name)))


def _once(refuse: Callable[..., None]) -> Callable[..., None]:
    said: dict[str, ModelError | None] = {}

    def inner(*given: Any) -> None:
        key = repr(given)
        if key not in said:
            try:
                refuse(*given)
                said[key] = None
            except ModelError as error:
                said[key] = error
        error = said[key]
        if error is not None:
            raise ModelError(str(error))

    return inner


class Recorder:
    """Stands for the mechanism of an example and remembers the last call."""

    def __init__(self, m: Mechanism) -> None:
        self.m = m
        self.call: tuple[str, tuple[Any, ...], dict[str, Any]] = ("", (), {})

    def __getattr__(self, method: str) -> Callable[..., Any]:
        def call(*given: Any, **named: Any) -> Any:
            self.call = method, given, named
            return getattr(self.m, method)(*given, **named)

        return call


def example(kind: Any, changes: dict[str, Any] | None = None) -> Mechanism | str:
    """A mechanism with the example of a kind, of which these arguments are others; or why it is refused."""
    m = Mechanism("example")
    first, second = m.body("first", 1.0, (0.1, -0.2), 0.3), m.bar("second", 0.8, 1.5)
    third = m.body("third", 2.0)
    i, j = first.at(0.11, 0.2, 0.3), second.at(-0.4, 0.5, -0.6)
    m.revolute("other", first.at(0.5, 0.5), third.origin)
    recorder = Recorder(m)
    kind.example(recorder, i, j)
    if changes is None:
        return m
    method, given, named = recorder.call
    for table in (m.joints, m.drivers, m.forces, m.contacts):
        table.pop("example", None)
    known = arguments(kind.add)
    several = [k for k, argument in enumerate(known) if argument.several]
    head, tail = (given[1 : 1 + several[0]], given[1 + several[0] :]) if several else (given[1:], ())
    positional = dict(zip([argument.name for argument in known], head, strict=False)) | named | changes
    first_ones = [positional.pop(argument.name) for argument in known[: len(head)]]
    given, named = (given[0], *first_ones, *tail), positional
    try:
        getattr(m, method)(*given, **named)
    except ModelError as error:
        return str(error)
    return m


def changed(m: Mechanism, values: dict[str, Any]) -> Mechanism | str:
    try:
        m.change("example", **values)
    except ModelError as error:
        return str(error)
    return m


def state(m: Mechanism) -> tuple[Any, ...]:
    """All that the solver gets, and all that a file gets."""
    packed = pack(m, list(m.contacts.values()))
    system = packed.system
    called = any("function" in joint.params for joint in packed.joints)  # by an address, another each time
    arrays = [np.asarray(getattr(system, name)).tobytes() for name in system._fields if name != "numbers" or not called]
    entries = [
        (table, name, dict(entry.params), [(k.body.name, k.x, k.y, k.angle) for k in (entry.i, entry.j)], entry.derived)
        for table in ("joints", "drivers", "forces", "contacts")
        for name, entry in getattr(m, table).items()
    ]  # fmt: skip
    return arrays, loads(packed), written(m), entries


def loads(packed: Packed) -> list[bytes]:
    if not all(force.kind.saved for force in packed.forces):
        return []  # functions are called by addresses
    return [np.asarray(part).tobytes() for part in pack_loads(packed) if isinstance(part, np.ndarray)]


def written(m: Mechanism) -> Any:
    try:
        return document(m)
    except ModelError as error:
        return str(error)


def values_of(kind: Any, name: str) -> list[Any]:
    """Other values of an argument."""
    if name in OTHERS:
        return OTHERS[name]
    [argument] = [known for known in arguments(kind.add) if known.name == name]
    if bool in argument.types:
        return [True, False]
    return [0.37, 1.4]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_every_argument_alone_and_in_pairs(kind: Any) -> None:
    own = [
        argument.name
        for argument in arguments(kind.add)
        if argument.role not in (Role.MARKER, Role.BODY, Role.OPTIONAL_BODY) and not argument.several
    ]
    single = [{name: value} for name in own for value in values_of(kind, name)]
    pairs = [a | b for a, b in itertools.combinations(single, 2) if not a.keys() & b.keys()]
    accepted: set[str] = set()
    some = 3 if "points" in own else 30  # curves take long
    for values in [*single, *pairs[:: max(1, len(pairs) // some)]]:
        there = example(kind)
        assert isinstance(there, Mechanism)
        here, fresh = changed(there, values), example(kind, values)
        if isinstance(here, str) or isinstance(fresh, str):
            assert isinstance(here, str), f"{values}: a new one is refused: {fresh}"
            assert isinstance(fresh, str), f"{values}: a change is refused: {here}"
            continue
        assert state(here) == state(fresh), values
        accepted |= values.keys()
    in_groups = {"teeth", "module", "pitch"}  # with each other alone: tests/kinematics/test_gears.py
    in_groups |= {"length"} if kind.name == "friction" else set()  # of guides: below
    in_groups |= (
        {"restitution"} if kind.name in ("contact", "clearance_joint", "gear_mesh") else set()
    )  # in place of damping: below
    in_groups |= {"modulus", "journal_modulus"} if kind.name == "clearance_joint" else set()  # of stiffness: below
    in_groups |= {"before", "after", "valve"}  # names of other joints
    in_groups |= {"orifice"} if kind.name == "hydraulic_cylinder" else set()  # in place of rated_flow: below
    assert accepted | in_groups >= set(own), f"never changed: {set(own) - accepted}"


INSTEAD: list[tuple[str, dict[str, Any]]] = [
    ("contact", {"damping": 0.0, "restitution": 0.6, "damping_model": "hunt_crossley"}),
    ("contact", {"damping": 0.0, "restitution": 0.6, "damping_model": "flores"}),
    ("clearance_joint", {"stiffness": None, "modulus": 2e9, "journal_modulus": 1e9, "radius": 0.2}),
    ("clearance_joint", {"stiffness": None, "modulus": 2e9, "journal_modulus": 1e9, "radius": 0.3}),
    ("hydraulic_cylinder", {"rated_flow": None, "orifice": 1e-4}),
]
"""Arguments that are given in place of another one."""


@pytest.mark.parametrize(("name", "values"), INSTEAD)
def test_one_argument_takes_the_place_of_another(name: str, values: dict[str, Any]) -> None:
    [kind] = [kind for kind in KINDS if kind.name == name]
    there = example(kind)
    assert isinstance(there, Mechanism)
    here, fresh = changed(there, values), example(kind, values)
    assert isinstance(here, Mechanism), here
    assert isinstance(fresh, Mechanism), fresh
    assert state(here) == state(fresh)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.saved], ids=lambda kind: kind.name)
def test_a_model_from_a_file_changes_as_the_one_it_was_made_of(kind: Any) -> None:
    for name in (
        argument.name
        for argument in arguments(kind.add)
        if argument.role in (Role.VALUE, Role.AMOUNT) and not argument.several
    ):
        for value in values_of(kind, name):
            m = example(kind)
            assert isinstance(m, Mechanism)
            here, loaded = changed(m, {name: value}), changed(build(document(example(kind)), Mechanism), {name: value})  # pyright: ignore[reportArgumentType]
            if isinstance(here, str):
                assert here == loaded
            else:
                assert isinstance(loaded, Mechanism), loaded
                assert state(here) == state(loaded), (name, value)


def test_motor_takes_the_argument_of_its_method() -> None:
    m = Mechanism("fan")
    rotor = m.body("rotor", 1.0, inertia=0.1)
    m.revolute("A", m.ground.origin, rotor.origin)
    m.motor("drive", m.ground, rotor, curve([0.0, 10.0], [1.0, 0.0]))
    other = curve([0.0, 20.0], [2.0, 0.0])
    m.change("drive", torque_speed=other)
    assert m.forces["drive"].laws == {"of_rate": other}


def test_friction_takes_a_joint_that_was_changed() -> None:
    m = Mechanism("hinge")
    rod = m.bar("rod", 0.5, 1.0)
    pin = m.revolute("A", m.ground.origin, rod.start)
    m.change("A", limits=(-1.0, 1.0))
    assert m.friction("F", pin, 0.1, radius=0.01).params["joint"] == "A"


def sled(coefficient: float = 0.7, **own: Any) -> Mechanism:
    """A block with a push on a rough guide."""
    m = Mechanism("sled")
    block = m.body("block", 1.0, inertia=0.01)
    m.prismatic("guide", m.ground.origin, block.origin)
    m.friction("F", "guide", coefficient, **own)
    m.force("push", block.origin, 5.0)
    m.start_near(block=(0, 0, 0))
    return m


@pytest.mark.parametrize("own", [{}, {"sticks": True}, {"static": 0.9}, {"length": 0.2}], ids=str)
@pytest.mark.parametrize(("before", "after"), [(0.7, 0.1), (0.1, 0.7)])
def test_a_block_slides_as_far_as_one_built_so(own: dict[str, Any], before: float, after: float) -> None:
    m, fresh = sled(before, **own), sled(after, **own)
    m.change("F", coefficient=after)
    assert state(m) == state(fresh)
    far, wanted = (float(k.simulate(0.3, steps=2).body("block").x[-1]) for k in (m, fresh))
    assert far == wanted
    if own == {"sticks": True} and after == 0.7:
        assert far == 0.0
    m.change("F", sticks=not own.get("sticks", False), slip_speed=None, length=0.1)
    assert state(m) == state(sled(after, **own | {"sticks": not own.get("sticks", False), "length": 0.1}))
