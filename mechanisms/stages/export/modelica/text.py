"""The text of a Modelica model: head, classes, components, connections.

Bodies keep the frames of their author; angles of joints are those of the second body against the first. What
PlanarMechanics has not, rods, gears, belts, springs along their line, drivers, stands as classes inside the model.
"""

from __future__ import annotations

from typing import Any

import mbsd
from mechanisms.stages.export.modelica.document import Document, identifier, law, number, vector
from mechanisms.stages.export.modelica.parts import (
    DRIVERS,
    FORCES,
    JOINTS,
    Parts,
    Places,
    Start,
    amount_of,
    chosen,
    place,
)
from mechanisms.stages.export.tree import GROUND

LIBRARY, STANDARD = "1.6.0", "4.0.0"
"""Versions of PlanarMechanics and of the Modelica Standard Library whose names these are."""
COORDINATED = ("revolute", "prismatic", "pin_in_slot", "weld")
"""Joints that say where a body is against another."""


def modelica(solution: Any) -> tuple[str, list[str]]:
    """Return the file's text, and what it leaves out."""
    m, start = solution.mechanism, Start.from_solution(solution)
    size = max(float(solution.packed.size), 1e-6)
    repeated = _repeated(solution)
    joints = [joint for joint in m.joints.values() if joint.kind.name in JOINTS and joint.name not in repeated]
    drivers = [driver for driver in m.drivers.values() if driver.kind.name in DRIVERS and law(driver.motion)]
    forces = [force for force in m.forces.values() if _is_said(force)]
    loose = _loose(m, joints)
    picked = chosen(start, [*joints, *drivers], loose, size)
    name = identifier(m.name)
    document = Document(name)
    document.lines.append(_world(m, size))
    places = Places(document, m.bodies)
    for body in m.bodies:
        if body != GROUND:
            places.add_body(body, _start_of(m.bodies[body], start, picked))
    parts = Parts(document, places, start, picked)
    for joint in joints:
        parts.joint(joint)
    for driver in drivers:
        parts.driver(driver, float(solution.t[0]))
    for force in forces:
        parts.force(force)
    left_out = _left_out(solution, {id(thing) for thing in (*joints, *drivers, *forces)})
    return _text(name, document, solution, left_out), left_out


def _repeated(solution: Any) -> set[str]:
    """Return joints of one row that hold what others hold already: with them the equations are singular."""
    joints = solution.mechanism.joints
    return {name for name in solution.mobility.redundant if name in joints and joints[name].kind.rows == 1}


def _is_said(force: Any) -> bool:
    if force.kind.name in ("force", "torque"):
        return amount_of(force, force.kind.name) is not None
    return force.kind.name in FORCES and not force.laws


def _loose(m: Any, joints: list[Any]) -> list[str]:
    """Return bodies whose place follows from no coordinate of a joint."""
    held, more = {GROUND}, {GROUND}
    while more:
        ends = [joint.bodies for joint in joints if joint.kind.name in COORDINATED]
        more = {name for pair in ends if held & set(pair) for name in pair} - held
        held |= more
    return [name for name in m.bodies if name not in held]


def _world(m: Any, size: float) -> str:
    gravity = vector(*(m.gravity or (0.0, 0.0)))
    return (
        f"  inner PlanarMechanics.PlanarWorld planarWorld(constantGravity={gravity}, nominalLength={number(size)})"
        ' "gravity in m/s2";'
    )


def _start_of(body: Any, start: Start, picked: set[tuple[str, str]]) -> dict[str, str]:
    """Return modifiers of a body: where its centre of mass is, as a guess or to start from."""
    at = body.at(*body.com)
    x, y = place(start.poses, at)
    rates = [start.rate(lambda poses, k=k: place(poses, at)[k]) for k in (0, 1)]
    theta, omega = (float(values[body.name][2]) for values in (start.poses, start.rates))
    fixed = [(body.name, axis) in picked for axis in ("x", "y", "theta")]
    pair = f", fixed={{{', '.join(str(is_so).lower() for is_so in fixed[:2])}}}" if any(fixed[:2]) else ""
    alone = ", fixed=true" if fixed[2] else ""
    return {
        "r": f"(start={vector(x, y)}{pair})",
        "v": f"(start={vector(*rates)}{pair})",
        "phi": f"(start={number(theta)}{alone})",
        "w": f"(start={number(omega)}{alone})",
    }


def _left_out(solution: Any, said: set[int]) -> list[str]:
    m = solution.mechanism
    groups = {"joint": m.joints, "driver": m.drivers, "force": m.forces, "contact": m.contacts}
    repeated = _repeated(solution)
    words = [
        f"{what} '{name}' ({thing.kind.name})" + (", which repeats what others hold" if name in repeated else "")
        for what, group in groups.items()
        for name, thing in group.items()
        if id(thing) not in said
    ]
    if solution.mobility.redundant_rows > len(repeated):
        names = ", ".join(f"'{name}'" for name in solution.mobility.redundant if name not in repeated)
        words.append(f"nothing of joints {names}, which repeat what others hold: a tool may find the model singular")
    return words


def _text(name: str, document: Document, solution: Any, left_out: list[str]) -> str:
    first, last = float(solution.t[0]), float(solution.t[-1])
    lines = [
        "within ;",
        f"// {solution.mechanism.name}, written by mbsd {mbsd.__version__}: SI units, angles in rad, counter-clockwise",
        f"// It needs the library PlanarMechanics {LIBRARY} and the Modelica Standard Library {STANDARD}.",
        "// Start values are those of mbsd's first output; those that are fixed are as many as there are freedoms.",
        *(f"// Left out: {words}" for words in left_out),
        f'model {name} "Planar mechanism {solution.mechanism.name}"',
        *document.classes,
        *document.lines,
        "equation",
        *document.connections,
        f"  annotation(experiment(StartTime={number(first)}, StopTime={number(last)}, Tolerance=1e-8),",
        f'    uses(PlanarMechanics(version="{LIBRARY}"), Modelica(version="{STANDARD}")));',
        f"end {name};",
    ]
    return "\n".join(lines) + "\n"
