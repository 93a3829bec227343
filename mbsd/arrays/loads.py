"""Forces as arrays and along a motion: elements, interactions, user functions, joint friction.

Contacts by penalty may be damped by the speed with which they began. A simulation notes it at each accepted step
(mbsd/dynamics/prepare/prepared.py). A driven motion is known at its outputs alone; there the depth between two outputs
is the cubic through both with their rates, and the approach is its slope where it begins to be above zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numba
import numpy as np
from numba.core.dispatcher import Dispatcher

from mbsd.arrays.directory import ForceRows, directory, slice_of
from mbsd.arrays.states import first_holding, widened, with_states
from mbsd.base.running import Kept
from mbsd.compiling.callback import Callback
from mbsd.equations.interactions import evaluation
from mbsd.equations.interactions.law import RESULTS, STATE, address_of, switches
from mbsd.equations.interactions.switching import APPROACHED, REMEMBERS, SIZE, SPEED_HERE, SWITCHING, VALUE, WIDTH
from mbsd.equations.joint_friction import BY_RATE, CAPSTAN, GUIDE, PIN, SLOT
from mbsd.equations.laws import Laws
from mbsd.equations.loads import Loads, remembers, stretches, tabulate_loads

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.force import Force


COLUMNS = 9
"""Number of columns of Loads.interaction."""
SHAPES = {"pin": PIN, "guide": GUIDE, "slot": SLOT}
"""Kernels' codes for the pairs of :attr:`mbsd.model.joint.JointKind.pair`."""
TURN = 2.0 * math.pi
SHARP = 1e-9
"""Slip speed, in sizes/s, of joints that stick, where no simulation looks for the events."""


def pack_loads(packed: Packed) -> Loads:
    """Return the loads of a packed mechanism; laws of forces are numbered after those of the drivers."""
    if packed.forces:
        return _loads(packed)
    none = _KEPT.get((), lambda: _loads(packed))
    return Loads(*[part.copy() if isinstance(part, np.ndarray) else part for part in none])  # pyright: ignore[reportArgumentType]


_KEPT: Kept[Loads] = Kept()
"""The loads of a mechanism without forces."""


def _loads(packed: Packed) -> Loads:
    system, forces = packed.system, list(directory(packed).values())
    element, place, term, number = [], [], [], []
    body, arm, axes = system.marker_body.tolist(), system.marker_arm.tolist(), system.marker_axis.tolist()
    for own in forces:
        i, j = own.markers
        first = own.term.start
        for part in own.elements:
            element.append((part.kind, body[i], body[j], first, first := first + len(part.terms)))
            ux, uy = axes[i]
            place.append((*arm[i], *((-uy, ux) if part.turned else (ux, uy)), *arm[j]))
            for addend in part.terms:
                term.append((addend.kind, own.law_row(addend.law)))
                number.append((addend.a, addend.b, addend.c))
    interaction, given, switch = _interactions(packed, forces)
    user, user_body, user_com = pack_user_forces(packed, forces)
    friction, friction_number = _friction(packed, forces)
    return Loads(
        np.array(element, np.int64).reshape(-1, 5),
        np.array(place, float).reshape(-1, 6),
        np.array(term, np.int64).reshape(-1, 2),
        np.array(number, float).reshape(-1, 3),
        np.zeros(3),
        interaction,
        given,
        np.zeros(STATE),
        switch,
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


def _interactions(packed: Packed, forces: Sequence[ForceRows]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the table (n, 9), all numbers and the table of sides (1 + n, WIDTH), for Loads."""
    number = {name: b for b, name in enumerate(packed.body_names)}
    every = [(own, *each) for own in forces for each in zip(own.interactions, own.blocks, strict=True)]
    rows, given = [], np.zeros(sum(len(block) for _, _, block in every))
    for own, interaction, block in every:
        i, j = number[interaction.i.body.name], number[interaction.j.body.name]
        arms = [(m.x - packed.com[b, 0], m.y - packed.com[b, 1]) for m, b in ((interaction.i, i), (interaction.j, j))]
        axis = math.cos(interaction.i.angle), math.sin(interaction.i.angle)
        numbers = list(interaction.numbers)
        if interaction.phased:
            numbers[0] += packed.phases.get(own.force.name, 0.0)
        called = (float(law_address(packed, own.force)),) if interaction.calls_law else ()
        between = interaction.j.angle - interaction.i.angle
        given[slice_of(block)] = *arms[0], *axis, *arms[1], between, *called, *numbers
        crank = number[interaction.crank] if interaction.crank else 0
        holding = first_holding(own.force, number) if interaction.with_states else (0, 0)
        function, law = address_of(interaction.function), own.law_row(interaction.law)
        rows.append((i, j, law, block.start, function, evaluation.address(), crank, *holding))
    switch = np.zeros((1 + len(rows), WIDTH))
    switch[0, SWITCHING] = any(switches(interaction.function) for _, interaction, _ in every)
    switch[0, SIZE], switch[0, REMEMBERS] = packed.size, any(interaction.remembers for _, interaction, _ in every)
    switch[1:, APPROACHED] = np.nan
    return np.array(rows, np.int64).reshape(-1, COLUMNS), given, switch


def _friction(packed: Packed, forces: Sequence[ForceRows]) -> tuple[np.ndarray, np.ndarray]:
    """Return the table (f, 7) and the numbers (f, 10), for Loads."""
    rows, numbers = [], []
    names = [joint.name for joint in packed.joints]
    sharp = SHARP * packed.size
    for own in forces:
        if own.friction:
            (i, j), p, name = own.markers, own.force.params, own.force.name
            k = names.index(p["joint"])
            shape = SHAPES[packed.joints[k].kind.pair or ""]
            second = int(packed.system.marker_body[j] > 0)
            way = packed.first_row[names.index(name)] if name in names else -1
            slip_speed = sharp if p["sticks"] else p["slip_speed"]
            if own.force.kind.of_spans:
                before, after = (packed.first_row[names.index(p[span])] for span in ("before", "after"))
                rows.append((CAPSTAN, i, j, before, after + 1, second, way))
                wrapped = -p["coefficient"] if p["clockwise"] else p["coefficient"]
                numbers.append((1.0, 1.0, 1.0, 0.0, slip_speed, 0.0, p["radius"], BY_RATE, wrapped, p["turns"] * TURN))
                continue
            rows.append((shape, i, j, packed.first_row[k], packed.first_row[k + 1], second, way))
            given = (p["coefficient"], p["static"], p["stribeck"], p["viscous"], slip_speed, p["preload"])
            numbers.append((*given, p["radius"] if shape == PIN else p["length"], BY_RATE, 0.0, 0.0))
    return np.array(rows, np.int64).reshape(-1, 7), np.array(numbers, float).reshape(-1, 10)


def pack_user_forces(packed: Packed, forces: Sequence[ForceRows]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the table (u, 3), bodies (b,) and centres of mass (b, 2) of user forces, for Loads.

    Centres are in the author's frames.
    """
    own = [each for each in forces if each.user]
    rows = [(_callback(packed, each.force).address, each.user_body.start, len(each.user_body)) for each in own]
    which = np.array([packed.body_names.index(name) for each in own for name in each.force.params["bodies"]], np.int64)
    return np.array(rows, np.int64).reshape(-1, 3), which, packed.com[which].reshape(-1, 2)


def _callback(packed: Packed, force: Force) -> Callback:
    """Return the callback of a force, made once for each packed mechanism, which keeps it alive."""
    count = len(force.params["bodies"])
    return packed.specials.callback(
        f"{packed.name}: force '{force.name}'",
        lambda what: Callback(force.params["function"], (3 * count, 3 * count), 3 * count, what),
    )


def law_address(packed: Packed, force: Force) -> int:
    """Return the address of the law of a spring, a function of value and rate (model/forces/springs.py)."""
    law = force.params["law"]
    return packed.specials.callback(
        f"{packed.name}: force '{force.name}'", lambda what: Callback(_timed(law), (1, 1), 1, what)
    ).address


_TIMED: Kept[Dispatcher] = Kept()


def _timed(law: Callable) -> Callable:
    def timed(t, value, rate):
        return law(value, rate)

    return _TIMED.get(law, lambda: numba.njit(timed)) if isinstance(law, Dispatcher) else timed


def approached_along(
    packed: Packed, loads: Loads, laws: Laws, t: np.ndarray, q: np.ndarray, v: np.ndarray
) -> np.ndarray | None:
    """Return (T, n) approach speeds of all interactions (m/s) along a motion; None if none needs them.

    q, v (T, 3 nb) are given at times (T,).
    """
    if not remembers(loads):
        return None
    count, table = len(loads.switch) - 1, loads.switch
    depth, rate = np.zeros((2, len(t), count))
    for k in range(len(t)):
        at, load = slice(k, k + 1), np.zeros((1, q.shape[1]))
        tabulate_loads(packed.system, loads, laws, t[at], q[at], v[at], packed.ws, load, np.zeros(1))
        depth[k], rate[k] = table[1:, VALUE], table[1:, SPEED_HERE]
    packed.specials.check()
    out = np.full((len(t), count), np.nan)
    for c in range(count):
        for k in range(1, len(t)):
            inside = depth[k, c] > 0.0
            if not inside:
                continue
            if depth[k - 1, c] > 0.0:
                out[k, c] = out[k - 1, c]
            else:
                out[k, c] = _slope_at_zero(t[k] - t[k - 1], depth[k - 1 : k + 1, c], rate[k - 1 : k + 1, c])
    return out


def _slope_at_zero(h: float, depth: np.ndarray, rate: np.ndarray) -> float:
    """Return the slope at its zero of the cubic over h (s) through ``depth`` (2,) with ``rate`` (2,).

    The depth is below 0 at first and above 0 then.
    """
    rise, (a, b) = depth[1] - depth[0], h * rate
    cubic = np.polynomial.Polynomial([depth[0], a, 3 * rise - 2 * a - b, a + b - 2 * rise])
    roots = cubic.roots()
    real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > -1e-9) & (roots.real < 1 + 1e-9)]
    return float(cubic.deriv()(real.max() if len(real) else 1.0)) / h


def loads_along(
    packed: Packed,
    loads: Loads,
    laws: Laws,
    t: np.ndarray,
    q: np.ndarray,
    v: np.ndarray,
    approached: np.ndarray | None = None,
    states: np.ndarray | None = None,
) -> np.ndarray:
    """Return (T, 3 nb) forces of all loads but friction along a motion q, v (T, 3 nb).

    They are generalised forces, zero for ground.

    ``approached`` (T, n): how fast contacts approached (m/s), where they ask for it; None: as kernels remember it now.
    ``states`` (T, n): those of forces (SI), of a mechanism that is packed without them.
    Raises ModelError where a function of the user fails.
    """
    if states is not None:
        wide = with_states(packed)
        wide_q, wide_v = widened(wide, q), widened(wide, v, states)
        return loads_along(wide, pack_loads(wide), laws, t, wide_q, wide_v, approached)[:, : q.shape[1]]
    out = np.zeros_like(q)
    if loads.total:
        power = np.zeros(len(t))
        for at in stretches(loads, approached, len(t)):
            tabulate_loads(packed.system, loads, laws, t[at], q[at], v[at], packed.ws, out[at], power[at])
        packed.specials.check()
        out[:, :3] = 0.0
    return out
