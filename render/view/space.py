"""Payload of a page in space: bodies, joints, drivers, points and forces of data.json version 4.

As payload.py has them in the plane, but:

    space, view            true; rows right and up (2, 3) of the picture of the 2D view
    bodies[name]           x y z qw qx qy qz vx vy vz wx wy wz ax ay az alphax alphay alphaz (T,); mass com inks
    joints[name]           kind, bodies; x y z fx fy fz mx my mz (T,); turn, slide (T,) or null; at {body, x, y, z}
    points[name]           body; x y z vx vy vz ax ay az (T,)
    forces[name]           value rate effort (T,) of one row, else fx fy fz mx my mz (T,) or null; power (T,) or null
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from shared.contract import Motion3
from shared.contract.skeleton import VIEW

PLACES = ("x", "y", "z")
RATES = tuple(f"{name}{axis}" for name in ("v", "a") for axis in "xyz")
TURNS = ("qw", "qx", "qy", "qz", *(f"{name}{axis}" for name in ("w", "alpha") for axis in "xyz"))
LOADS = tuple(f"{name}{axis}" for name in ("f", "m") for axis in "xyz")


def things_in_space(motion: Motion3) -> dict[str, Any]:
    """Return the keys of a page that differ from those of a motion in the plane."""
    return {
        "space": True,
        "view": [list(row) for row in VIEW],
        "bodies": {
            name: _series(body, *PLACES, *RATES, *TURNS)
            | {"mass": body.mass, "com": list(body.com), "inks": [body.colour, body.colour_on_dark]}
            for name, body in motion.bodies.items()
        },
        "joints": {
            name: _series(joint, *PLACES, *LOADS, "turn", "slide")
            | {"kind": joint.kind, "bodies": list(joint.bodies)}
            | {"at": {"body": joint.bodies[1]} | dict(zip("xyz", joint.markers[1].place, strict=True))}
            for name, joint in motion.joints.items()
        },
        "drivers": {
            name: _series(driver, "value", "effort", "power") | _said(driver) for name, driver in motion.drivers.items()
        },
        "points": {
            name: _series(point, *PLACES, *RATES) | {"body": point.body} for name, point in motion.points.items()
        },
        "forces": {name: _force(force) | _said(force) for name, force in motion.forces.items()},
        "contacts": {},
        "couple": None,
        "frame": None,
        "marks": [
            {"time": event.time, "words": f"{event.name}: {event.what}", "kind": "event"}
            for event in motion.events
            if event.what != "end"
        ],
    }


def _series(thing: Any, *names: str) -> dict[str, Any]:
    """Return series of a thing by name, None of those it lacks."""
    series: Mapping[str, Any] = {name: getattr(thing, name) for name in names}
    return {name: None if values is None else np.asarray(values, np.float32) for name, values in series.items()}


def _said(thing: Any) -> dict[str, Any]:
    units = {"unit": thing.unit, "effort_unit": thing.effort_unit}
    return {"kind": thing.kind, "bodies": list(thing.bodies)} | units


def _force(force: Any) -> dict[str, Any]:
    if len(force.rows) == 1:
        return _series(force.rows[0], "value", "rate", "effort") | _series(force, "power")
    return {"value": None, "rate": None, "effort": None} | _series(force, *LOADS, "power")
