"""Quantities that a program without Python may read and set: names, units, and where each number is.

states       coordinates and speeds of each body's centre of mass, states of forces, and the work of forces
inputs       a force and a torque on each body, constant forces of the model, rates of drivers that turn steadily
parameters   mass and inertia of bodies, gravity, constants of springs and dampers
outputs      the motion of each body's frame, reactions of joints, drivers with their efforts, energy
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from mbsd.arrays.directory import directory, made_of_masses, terms_of
from mbsd.base.codes import CONSTANT, DAMPING, DRY, LINEAR, POLYNOMIAL, TURN
from mbsd.dynamics.state import POWER, WORK
from mbsd.model.mechanism import Model
from mbsd.native.equations import NativeEquations

MEMORY, FRAME, JOINT, DRIVER, ENERGY, MASS, INERTIA, GRAVITY, RATE, LOAD = range(10)
"""Access to a number: where it stands in the memory (LOAD: and forces change with it), or its index."""
KINDS = ("number", "body", "joint", "driver", "energy", "mass", "inertia", "gravity", "driver", "force")
"""Prefixes of a name that would otherwise stand for two things."""
STATE, INPUT, PARAMETER, OUTPUT = "state", "input", "parameter", "output"
OUTSIDE = " from outside"
"""Ending of the names of forces that are added for inputs."""


@dataclass(frozen=True)
class Quantity:
    """One number by name."""

    name: str
    unit: str
    words: str
    role: str
    kind: int
    index: int = 0
    component: int = 0
    place: int = -1
    """Bytes from the start of the memory."""
    start: float = 0.0
    rate_of: str = ""
    """The state whose derivative it is."""
    size: float = 1.0
    """The usual size of a state."""


def with_inputs(m: Model) -> Any:
    """Return a copy of a mechanism with zero forces along x and y and a zero torque on each body.

    Forces act at the centre of mass.
    """
    import copy

    out: Any = copy.deepcopy(m)
    for name, body in list(out.bodies.items()):
        if body is out.ground:
            continue
        at = body.at(*body.com)
        out.force(f"{name}.load.fx{OUTSIDE}", at, 0.0, (1.0, 0.0))
        out.force(f"{name}.load.fy{OUTSIDE}", at, 0.0, (0.0, 1.0))
        out.torque(f"{name}.load.torque{OUTSIDE}", body, 0.0)
    return out


def quantities_of(equations: NativeEquations) -> list[Quantity]:
    """Return all quantities: states, inputs, parameters, outputs; rates of states are outputs too."""
    named: dict[str, Quantity] = {}
    for part in (_states, _inputs, _parameters, _outputs):
        for quantity in part(equations):
            name = quantity.name
            while name in named:
                name = f"{KINDS[quantity.kind]}.{name}"
            named[name] = replace(quantity, name=name)
    return list(named.values())


def _states(equations: NativeEquations) -> Iterator[Quantity]:
    """Coordinates first, then speeds, then work, as their array has them."""
    packed, state, place = equations.ready.packed, equations.state, equations.memory.offset
    coordinates = [(body, c) for body in range(1, len(packed.body_names)) for c in range(3)]
    for part in range(2):
        for body, c in coordinates:
            entry = 3 * body + c
            of = f"{packed.body_names[body]}.center"
            name = f"{of}.{('x', 'y', 'angle')[c]}" if part == 0 else f"{of}.{('vx', 'vy', 'omega')[c]}"
            words = ("coordinate", "speed")[part] + " of the centre of mass in the world"
            yield Quantity(
                name, _unit(c, part), words, STATE, MEMORY, place=place(state.y, part, entry),
                start=float(state.y[part, entry]), size=1.0 if c == 2 else packed.size,
                rate_of=f"{of}.{('x', 'y', 'angle')[c]}" if part else "",
            )  # fmt: skip
    yield Quantity("work", "J", "work of forces and drivers since the start, weight left out", STATE, MEMORY,
                   place=place(state.clock, WORK))  # fmt: skip


def _unit(component: int, order: int) -> str:
    return ("rad" if component == 2 else "m") + ("", "/s", "/s2")[order]


def _inputs(equations: NativeEquations) -> Iterator[Quantity]:
    packed, laws = equations.ready.packed, equations.ready.dynamics.laws
    for name, unit, term, a in _constants(equations):
        if name.endswith(OUTSIDE):
            body = name.removesuffix(OUTSIDE)
            words = "torque from outside" if unit == "N.m" else "force from outside at the centre of mass, world axes"
            yield Quantity(body, unit, words, INPUT, LOAD, place=term)
        else:
            yield Quantity(name, unit, "the model's own, in place of its constant", INPUT, LOAD, place=term, start=a)
    for k, (name, motion) in enumerate(zip(packed.driver_names, packed.motions, strict=True)):
        first, end = int(laws.first[k + 1]), int(laws.first[k + 2])
        if laws.kind[k + 1] == POLYNOMIAL and end - first == 2 and motion is not None:
            angular = packed.drivers[k].kind.angular
            yield Quantity(
                f"{name}.rate", "rad/s" if angular else "m/s", "of the driver; its value goes on where it stands",
                INPUT, RATE, index=k, place=equations.memory.offset(laws.numbers, first),
                start=float(laws.numbers[first + 1]),
            )  # fmt: skip


def _constants(equations: NativeEquations) -> Iterator[tuple[str, str, int, float]]:
    """Forces that are one constant: name, unit, place of the number, its value."""
    for term, of, row, alone, turns in _terms(equations):
        if term.kind == CONSTANT and alone:
            name = of if of.endswith(OUTSIDE) else f"{of}.{'torque' if turns else 'force'}"
            yield name, "N.m" if turns else "N", _number_place(equations, row), term.a


def _terms(equations: NativeEquations) -> Iterator[tuple[Any, str, int, bool, bool]]:
    """Yield terms: term, owner, row of Loads.number, True if the force is only it, True for a torque."""
    for name, rows in directory(equations.ready.packed).items():
        every = [(element, number) for number, element in enumerate(rows.elements, 1) for _ in element.terms]
        for (element, number), term, row in zip(every, terms_of(rows.elements), rows.term, strict=True):
            of = name if len(rows.elements) == 1 else f"{name}.{number}"
            yield term, of, row, len(every) == len(rows.elements) == 1, element.kind == TURN


def _number_place(equations: NativeEquations, row: int, column: int = 0) -> int:
    return equations.memory.offset(equations.ready.dynamics.loads.number, row, column)


def _parameters(equations: NativeEquations) -> Iterator[Quantity]:
    packed, dynamics = equations.ready.packed, equations.ready.dynamics
    gravity = packed.system.gravity
    for c in range(2):
        yield Quantity(f"gravity.{'xy'[c]}", "m/s2", "", PARAMETER, GRAVITY, component=c, start=float(gravity[c]))
    if not made_of_masses(packed):
        for b, name in enumerate(packed.body_names[: len(packed.body_names) - packed.states]):
            for kind, c, unit, word in ((MASS, 0, "kg", "mass"), (INERTIA, 2, "kg.m2", "inertia")):
                value = float(dynamics.inertia[3 * b + c])
                if b and value > 0.0 and dynamics.inverse[3 * b + c] == dynamics.metric[3 * b + c] == 1.0 / value:
                    words = "about the centre of mass" if c else ""
                    yield Quantity(f"{name}.{word}", unit, words, PARAMETER, kind, index=b, start=value)
    for term, of, row, alone, turns in _terms(equations):
        for word, unit, column, value in _named(term, turns, alone):
            yield Quantity(f"{of}.{word}", unit, "", PARAMETER, LOAD, place=_number_place(equations, row, column),
                           start=float(value))  # fmt: skip


def _named(term: Any, turns: bool, alone: bool) -> list[tuple[str, str, int, float]]:
    """Word, unit, column of Loads.number and value of the numbers of a term that can be said in words."""
    effort, length, rate = ("N.m", "rad", "rad/s") if turns else ("N", "m", "m/s")
    per_length, per_rate = ("N.m/rad", "N.m.s/rad") if turns else ("N/m", "N.s/m")
    if term.kind == LINEAR:
        return [("stiffness", per_length, 0, term.a), ("free_angle" if turns else "free_length", length, 1, term.b)]
    if term.kind == DAMPING:
        return [("damping", per_rate, 0, term.a)]
    if term.kind == DRY:
        return [("dry_friction", effort, 0, term.a), ("slip_speed", rate, 1, term.b)]
    if term.kind == CONSTANT and not alone:
        return [("constant", effort, 0, term.a)]
    return []


def _traces(equations: NativeEquations) -> list[tuple[str, Any]]:
    return list(equations.model.traces.items())


def frames_of(equations: NativeEquations) -> list[tuple[int, float, float, float]]:
    """Return body, place (m) and angle (rad) of each frame: of bodies, then of traces.

    The place is from the body's centre of mass in its axes.
    """
    packed = equations.ready.packed
    bodies = range(len(packed.body_names) - packed.states)
    frames = [(b, -float(packed.com[b, 0]), -float(packed.com[b, 1]), 0.0) for b in bodies]
    for _, marker in _traces(equations):
        b = packed.body_names.index(marker.body.name)
        frames.append((b, marker.x - float(packed.com[b, 0]), marker.y - float(packed.com[b, 1]), marker.angle))
    return frames


def _outputs(equations: NativeEquations) -> Iterator[Quantity]:
    packed, state, place = equations.ready.packed, equations.state, equations.memory.offset
    bodies = packed.body_names[: len(packed.body_names) - packed.states]
    for b, name in enumerate(bodies):
        for k, word in enumerate(("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")):
            if b:
                words = "of the body's frame in the world"
                yield Quantity(f"{name}.{word}", _unit(k % 3, k // 3), words, OUTPUT, FRAME, index=b, component=k)
    for k, (name, _) in enumerate(_traces(equations), len(packed.body_names) - packed.states):
        for c, word in enumerate(("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")):
            yield Quantity(f"{name}.{word}", _unit(c % 3, c // 3), "of the traced point", OUTPUT, FRAME, k, c)
    joints = packed.passive_joints
    for k, joint in enumerate(joints):
        for c, word in enumerate(("fx", "fy", "torque")):
            words = "of the joint on its second body at its second marker"
            yield Quantity(f"{joint.name}.{word}", "N.m" if c == 2 else "N", words, OUTPUT, JOINT, k, c)
    for k, name in enumerate(packed.driver_names):
        angular = packed.drivers[k].kind.angular
        for c, word in enumerate(("value", "speed", "acceleration", "effort")):
            unit = ("N.m" if angular else "N") if c == 3 else _unit(2 if angular else 0, c)
            yield Quantity(f"{name}.{word}", unit, "of the driver", OUTPUT, DRIVER, k, c)
    for c, word in enumerate(("kinetic", "gravity")):
        words = ("of all bodies", "potential energy of weight, from the origin")[c]
        yield Quantity(f"energy.{word}", "J", words, OUTPUT, ENERGY, component=c)
    for b in range(1, len(packed.body_names)):
        for c, word in enumerate(("ax", "ay", "alpha")):
            of = f"{packed.body_names[b]}.center"
            yield Quantity(
                f"{of}.{word}", _unit(c, 2), "acceleration of the centre of mass", OUTPUT, MEMORY,
                place=place(state.dy, 1, 3 * b + c), rate_of=f"{of}.{('vx', 'vy', 'omega')[c]}",
            )  # fmt: skip
    yield Quantity("power", "W", "of forces and drivers, weight left out", OUTPUT, MEMORY,
                   place=place(state.clock, POWER), rate_of="work")  # fmt: skip
