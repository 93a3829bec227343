"""Forces of the user as arrays, and the kernel that calls their functions; see forces/user_force.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numba
import numpy as np
from numba.core.dispatcher import Dispatcher

from mbsd.callback import Callback, call
from mbsd.jit import internal

if TYPE_CHECKING:
    from mbsd.force import Force
    from mbsd.packing import Packed


def pack_user_forces(packed: Packed) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The table (u, 3), the bodies (b,) and their centres of mass (b, 2) in the author's frames, for Loads."""
    rows: list[tuple[int, int, int]] = []
    bodies: list[int] = []
    for force in packed.forces:
        if "function" in force.params:
            named = [packed.body_names.index(name) for name in force.params["bodies"]]
            rows.append((_callback(packed, force).address, len(bodies), len(named)))
            bodies += named
    which = np.array(bodies, np.int64)
    return np.array(rows, np.int64).reshape(-1, 3), which, packed.com[which].reshape(-1, 2)


def _callback(packed: Packed, force: Force) -> Callback:
    """Made once for each packed mechanism, which keeps it alive."""
    count = len(force.params["bodies"])
    return packed.specials.callback(
        f"{packed.name}: force '{force.name}'",
        lambda what: Callback(force.params["function"], (3 * count, 3 * count), 3 * count, what),
    )


def law_address(packed: Packed, force: Force) -> int:
    """Where the law of a spring is, a function of its value and rate; see forces/spring_law.py."""
    law = force.params["law"]

    def timed(t, value, rate):
        return law(value, rate)

    return packed.specials.callback(
        f"{packed.name}: force '{force.name}'",
        lambda what: Callback(numba.njit(timed) if isinstance(law, Dispatcher) else timed, (1, 1), 1, what),
    ).address


@internal
def apply_user_forces(loads, t, q, v, cos_sin, load):
    """Add the generalised forces of all functions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    Returns their power (W).
    """
    given = loads.exchange[0]
    out = loads.exchange[1]
    power = 0.0
    for k in range(loads.user.shape[0]):
        first = loads.user[k, 1]
        count = loads.user[k, 2]
        for n in range(count):
            b = loads.user_body[first + n]
            c = cos_sin[b, 0]
            s = cos_sin[b, 1]
            x = c * loads.user_com[first + n, 0] - s * loads.user_com[first + n, 1]
            y = s * loads.user_com[first + n, 0] + c * loads.user_com[first + n, 1]
            rate = 3 * (count + n)
            given[3 * n] = q[3 * b] - x
            given[3 * n + 1] = q[3 * b + 1] - y
            given[3 * n + 2] = q[3 * b + 2]
            given[rate] = v[3 * b] + v[3 * b + 2] * y
            given[rate + 1] = v[3 * b + 1] - v[3 * b + 2] * x
            given[rate + 2] = v[3 * b + 2]
        call(loads.user[k, 0], t, given, out)  # pyright: ignore[reportCallIssue]
        for n in range(count):
            b = loads.user_body[first + n]
            rate = 3 * (count + n)
            fx = out[3 * n]
            fy = out[3 * n + 1]
            load[3 * b] += fx
            load[3 * b + 1] += fy
            # the frame's origin against the centre of mass
            x = given[3 * n] - q[3 * b]
            y = given[3 * n + 1] - q[3 * b + 1]
            load[3 * b + 2] += out[3 * n + 2] + x * fy - y * fx
            power += fx * given[rate] + fy * given[rate + 1] + out[3 * n + 2] * given[rate + 2]
    return power
