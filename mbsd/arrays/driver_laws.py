"""Checks of drivers' laws before solving: finite, positive distances, consistent f' and f''.

A sweep takes f, f' and f'' as the law gives them. Where its author gave the derivatives, they are compared with f once,
by making the quintic pieces of which a simulation is made (mbsd/model/laws/fitting/exact.py).
"""

from __future__ import annotations

import weakref

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.base.quantity import written
from mbsd.base.users_function import law_of
from mbsd.model.laws import Motion

LARGEST_ANGLE = 1e12
"""Largest angle of a driver (rad): beyond it neighbouring numbers are more than 1e-4 rad apart."""
LOOKS = 17
"""Times at which every law is evaluated before each analysis."""
_SPREAD = np.linspace(0.0, 1.0, LOOKS)
MOST_SPANS = 64
"""Spans of one law that are remembered as checked."""
_CHECKED: dict[int, tuple[weakref.ref[Motion], set[bytes]]] = {}
"""Laws by identity, and for which times and values their derivatives were found right."""


def refuse_bad_laws(packed: Packed, start: float, end: float) -> None:
    """Raise ModelError for an infinite law, a distance that is not positive, or wrong derivatives."""
    drivers = packed.drivers
    if not drivers:
        return
    times = start + (end - start) * _SPREAD
    times[-1] = end
    for driver, law in zip(drivers, packed.motions, strict=True):
        with law_of(f"{packed.name}: driver '{driver.name}'"):
            values = number_array("what its law gives", law(times), finite=False)
        shape = np.shape(values)
        if shape != (len(times), 3):
            raise ModelError(
                f"{packed.name}: driver '{driver.name}': its law gives {shown(values)} of shape {shape} for "
                f"{len(times)} times; it must give ({len(times)}, 3): f, f', f'' at each time"
            )
        good = np.isfinite(values).all(axis=1)
        if not good.all():
            bad = int(np.argmin(good))
            raise ModelError(
                f"{packed.name}: driver '{driver.name}': its law gives {values[bad][~np.isfinite(values[bad])][0]} at "
                f"t = {times[bad]:.6g} s; it must be finite"
            )
        farthest = float(np.abs(values[:, 0]).max())
        if driver.kind.angular and farthest > LARGEST_ANGLE:
            raise ModelError(
                f"{packed.name}: driver '{driver.name}' turns to {written(farthest, 'rad', 4)} by t = {end:.6g} s, "
                "where numbers no longer tell one angle from the next; end the motion earlier, or let the law repeat"
            )
        if driver.kind.constraints == ("distance",) and values[:, 0].min() <= 0:
            raise ModelError(
                f"{packed.name}: driver '{driver.name}' imposes a distance of {values[:, 0].min():.4g} m; "
                "it must stay positive"
            )
        if law.given_derivatives:
            with law_of(f"{packed.name}: driver '{driver.name}'"):
                _refuse_wrong_derivatives(driver.motion or law, law, start, end, values)


def _refuse_wrong_derivatives(given: Motion, law: Motion, start: float, end: float, values: np.ndarray) -> None:
    """Compare a law with its derivatives over ``start`` .. ``end`` (s), unless its values were compared.

    ``given``: the law as its author made it, ``law``: the same made ready; ``values`` (LOOKS, 3): what it gives now, by
    which a function that changes meanwhile is noticed.
    """
    key = np.array([start, end]).tobytes() + np.asarray(values, float).tobytes()
    known = _CHECKED.get(id(given))
    if known is not None and known[0]() is given and key in known[1]:
        return
    law.compiled(start, end)
    if known is None or known[0]() is not given:
        number = id(given)
        known = weakref.ref(given, lambda _: _CHECKED.pop(number, None)), set()
        _CHECKED[number] = known
    if len(known[1]) >= MOST_SPANS:
        known[1].clear()
    known[1].add(key)
