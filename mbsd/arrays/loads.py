"""Forces as arrays: elements and terms, interactions, functions of the user, friction of joints."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.states import first_holding
from mbsd.arrays.user_forces import law_address, pack_user_forces
from mbsd.base.kept import Kept
from mbsd.equations.interactions import call
from mbsd.equations.interactions.law import RESULTS, STATE, address_of, switches
from mbsd.equations.interactions.switching import APPROACHED, REMEMBERS, SIZE, SWITCHING, WIDTH
from mbsd.equations.joint_friction import BY_RATE, GUIDE, PIN
from mbsd.equations.loads import Loads

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


COLUMNS = 9
"""Number of columns of Loads.interaction."""
SHAPES = {"pin": PIN, "guide": GUIDE, "slot": 2}
"""What the kernels call the pairs of :attr:`mbsd.model.joint.JointKind.pair`."""
SHARP = 1e-9
"""Slip speed, in sizes/s, of joints that stick, where no simulation looks for the events."""


def pack_loads(packed: Packed) -> Loads:
    """The loads of a packed mechanism; laws of forces are numbered after those of the drivers."""
    if packed.forces:
        return _loads(packed)
    none = _KEPT.get((), lambda: _loads(packed))
    return Loads(*[part.copy() if isinstance(part, np.ndarray) else part for part in none])  # pyright: ignore[reportArgumentType]


_KEPT: Kept[Loads] = Kept()
"""The loads of a mechanism without forces."""


def _loads(packed: Packed) -> Loads:
    element, where, term, number = [], [], [], []
    system = packed.system
    law = len(packed.motions)
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        numbered = {name: law + 1 + k for k, name in enumerate(force.laws)}
        law += len(force.laws)
        for part in force.kind.elements(force):
            bodies = system.marker_body[i], system.marker_body[j]
            element.append((part.kind, *bodies, len(term), len(term) + len(part.terms)))
            ux, uy = system.marker_axis[i]
            axis = (-uy, ux) if part.turned else (ux, uy)
            where.append((*system.marker_arm[i], *axis, *system.marker_arm[j]))
            for addend in part.terms:
                term.append((addend.kind, numbered[addend.law] if addend.law else 0))
                number.append((addend.a, addend.b, addend.c))
    interaction, given, switching, remembers = pack_interactions(packed)
    user, user_body, user_com = pack_user_forces(packed)
    friction, friction_number = pack_friction(packed)
    return Loads(
        np.array(element, np.int64).reshape(-1, 5),
        np.array(where, float).reshape(-1, 6),
        np.array(term, np.int64).reshape(-1, 2),
        np.array(number, float).reshape(-1, 3),
        np.zeros(3),
        interaction,
        given,
        np.zeros(STATE),
        _switch(packed.size, len(interaction), switching, remembers),
        user,
        user_body,
        user_com,
        np.zeros((2, max(RESULTS, 6 * int(user[:, 2].max(initial=1))))),
        friction,
        friction_number,
        np.zeros((4, len(friction))),
        np.zeros(3),
        len(element) + len(interaction) + len(user),
    )


def pack_interactions(packed: Packed) -> tuple[np.ndarray, np.ndarray, bool, bool]:
    """The table (n, 9) and all numbers, for Loads; whether any has kinks or jumps that it tells, and remembers them."""
    switching = remembers = False
    number = {name: b for b, name in enumerate(packed.body_names)}
    rows, given, at, law = [], [], 0, len(packed.motions)
    for force in packed.forces:
        numbered = {name: law + 1 + k for k, name in enumerate(force.laws)}
        law += len(force.laws)
        for interaction in force.kind.interactions(force, packed.masses):
            i, j = number[interaction.i.body.name], number[interaction.j.body.name]
            arms = [
                (m.x - packed.com[b, 0], m.y - packed.com[b, 1]) for m, b in ((interaction.i, i), (interaction.j, j))
            ]
            axis = math.cos(interaction.i.angle), math.sin(interaction.i.angle)
            numbers = list(interaction.numbers)
            if interaction.phased:
                numbers[0] += packed.phases.get(force.name, 0.0)
            called = (float(law_address(packed, force)),) if interaction.calls_law else ()
            block = np.array(
                [*arms[0], *axis, *arms[1], interaction.j.angle - interaction.i.angle, *called, *numbers],
                float,
            )
            law_of, crank = (
                numbered[interaction.law] if interaction.law else 0,
                number[interaction.crank] if interaction.crank else 0,
            )
            holding = first_holding(force, number) if interaction.with_states else (0, 0)
            rows.append((i, j, law_of, at, address_of(interaction.function), call.address(), crank, *holding))
            given.append(block)
            at += len(block)
            switching = switching or switches(interaction.function)
            remembers = remembers or interaction.remembers
    table = np.array(rows, np.int64).reshape(-1, COLUMNS)
    return table, np.concatenate(given) if given else np.zeros(0), switching, remembers


def _switch(size: float, count: int, switching: bool, remembers: bool) -> np.ndarray:
    """(1 + count, WIDTH) for Loads."""
    table = np.zeros((1 + count, WIDTH))
    table[0, SWITCHING], table[0, SIZE], table[0, REMEMBERS] = switching, size, remembers
    table[1:, APPROACHED] = np.nan
    return table


def pack_friction(packed: Packed) -> tuple[np.ndarray, np.ndarray]:
    """The table (f, 7) and the numbers (f, 8), for Loads."""
    rows, numbers = [], []
    names = [joint.name for joint in packed.joints]
    sharp = SHARP * packed.size
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.of_reactions:
            p, k = force.params, names.index(force.params["joint"])
            shape = SHAPES[packed.joints[k].kind.pair or ""]
            second = int(packed.system.marker_body[j] > 0)
            way = packed.first_row[names.index(force.name)] if force.name in names else -1
            rows.append((shape, i, j, packed.first_row[k], packed.first_row[k + 1], second, way))
            slip_speed = sharp if p["sticks"] else p["slip_speed"]
            own = (p["coefficient"], p["static"], p["stribeck"], p["viscous"], slip_speed, p["preload"])
            numbers.append((*own, p["radius"] if shape == PIN else p["length"], BY_RATE))
    return np.array(rows, np.int64).reshape(-1, 7), np.array(numbers, float).reshape(-1, 8)
