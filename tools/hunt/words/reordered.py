"""One mechanism in other words: its parts in another order, the ends of joints and forces exchanged."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from mbsd import Mechanism
from tools.hunt.words.described import seen_from
from tools.hunt.words.raised import raised

SYMMETRIC = {
    "revolute",
    "weld",
    "distance",
    "angle_lock",
    "prismatic",
    "belt",
    "spring",
    "curve_of_length",
    "gravitation",
    "drive_distance",
    "rope",
}
"""Kinds whose ends may be exchanged as they are; limits change their sign."""


def shuffled(m: Mechanism, rng: np.random.Generator) -> Mechanism:
    """Bodies, joints, drivers and forces in another order."""
    out = seen_from(m, {})
    for name in ("bodies", "joints", "drivers", "forces", "contacts"):
        table = getattr(out, name)
        keys = list(table)
        order = [keys[k] for k in rng.permutation(len(keys))]
        if name == "bodies":
            order = ["ground", *(key for key in order if key != "ground")]
        entries = {key: table[key] for key in order}
        table.clear()
        table.update(entries)
    return out


def exchanged(m: Mechanism, rng: np.random.Generator) -> Mechanism:
    """First and second marker exchanged of half of what allows it."""
    out = seen_from(m, {})
    rubbed = {force.params.get("joint") for force in out.forces.values()}
    for table in (out.joints, out.drivers, out.forces, out.contacts):
        for name, joint in table.items():
            if rng.random() < 0.5 and name not in rubbed:
                table[name] = _turned_round(joint)
    return out


def _turned_round(joint: Any) -> Any:
    """The same joint or force with its ends exchanged; as it is where the kind does not allow it."""
    params, kind = dict(joint.params), joint.kind.name
    if kind == "drive_relative_angle":
        return replace(joint, i=joint.j, j=joint.i, motion=raised(joint.motion, 0.0, sign=-1.0))
    if kind == "torsion_spring" and "free_angle" not in joint.laws:
        params["free_angle"] = -params.get("free_angle", 0.0)
        return replace(joint, i=joint.j, j=joint.i, params=params)
    if kind in ("gear_pair", "rigid_discs"):
        if params.get("internal") or params.get("inside"):
            return joint
    elif kind not in SYMMETRIC:
        return joint
    if "radius_i" in params:
        params["radius_i"], params["radius_j"] = params["radius_j"], params["radius_i"]
    for pair in ("teeth", "phase"):
        if params.get(pair) is not None:
            params[pair] = tuple(reversed(params[pair]))
    if params.get("limits") is not None:
        low, high = params["limits"]
        params["limits"] = (None if high is None else -high, None if low is None else -low)
    return replace(joint, i=joint.j, j=joint.i, params=params)
