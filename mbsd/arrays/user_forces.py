"""Functions of the user in forces, at addresses that kernels call; see mbsd/equations/user_forces.py."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numba
import numpy as np
from numba.core.dispatcher import Dispatcher

from mbsd.base.kept import Kept
from mbsd.compiling.callback import Callback

if TYPE_CHECKING:
    from mbsd.arrays.directory import ForceRows
    from mbsd.arrays.packing import Packed
    from mbsd.model.force import Force


def pack_user_forces(packed: Packed, forces: Sequence[ForceRows]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the table (u, 3), the bodies (b,) and their centres of mass (b, 2) in the author's frames, for Loads."""
    own = [each for each in forces if each.user]
    rows = [(_callback(packed, each.force).address, each.user_body.start, len(each.user_body)) for each in own]
    which = np.array([packed.body_names.index(name) for each in own for name in each.force.params["bodies"]], np.int64)
    return np.array(rows, np.int64).reshape(-1, 3), which, packed.com[which].reshape(-1, 2)


def _callback(packed: Packed, force: Force) -> Callback:
    """Made once for each packed mechanism, which keeps it alive."""
    count = len(force.params["bodies"])
    return packed.specials.callback(
        f"{packed.name}: force '{force.name}'",
        lambda what: Callback(force.params["function"], (3 * count, 3 * count), 3 * count, what),
    )


def law_address(packed: Packed, force: Force) -> int:
    """Where the law of a spring is, a function of its value and rate; see mbsd/model/forces/spring_law.py."""
    law = force.params["law"]
    return packed.specials.callback(
        f"{packed.name}: force '{force.name}'", lambda what: Callback(_timed(law), (1, 1), 1, what)
    ).address


_TIMED: Kept[Dispatcher] = Kept()


def _timed(law: Callable) -> Callable:
    def timed(t, value, rate):
        return law(value, rate)

    return _TIMED.get(law, lambda: numba.njit(timed)) if isinstance(law, Dispatcher) else timed
