"""Laws of drivers and forces as one table; their jumps, and checks of drivers' laws before solving.

A sweep takes f, f' and f'' as the law gives them. Where its author gave the derivatives, they are compared with f once,
by making the quintic pieces of which a simulation is made (mbsd/model/laws/fitting/exact.py). Laws of time jump where
those pieces disagree: in f of a force, in f'' of a driver.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.directory import directory
from mbsd.arrays.packing import Packed
from mbsd.base.arguments import law_of, number_array, tell_missed
from mbsd.base.codes import PIECES
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.base.quantity import written
from mbsd.equations.laws import Laws, tabulate_law
from mbsd.model.laws import Motion
from mbsd.model.laws.fitting.leaves import finest
from mbsd.model.laws.numbers import ZERO, Compiled

if TYPE_CHECKING:
    from mbsd.model.force import Force


def pack_laws(laws: Sequence[Compiled]) -> Laws:
    """Return one table of laws; the constant zero is put before them."""
    everything = [ZERO, *laws]
    sizes = [len(numbers) for _, numbers in everything]
    return Laws(
        np.array([kind for kind, _ in everything], np.int64),
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
        np.concatenate([np.asarray(numbers, float) for _, numbers in everything]),
    )


def compiled_laws(packed: Packed, start: float, end: float) -> Laws:
    """Return the laws of drivers, then those of forces, for times ``start`` .. ``end`` (s)."""
    laws = []
    for name, motion in zip(packed.driver_names, packed.motions, strict=True):
        with law_of(f"{packed.name}: driver '{name}'"):
            laws.append(motion.compiled(start, end))
    for force in packed.forces:
        for what, law in force.laws.items():
            with law_of(f"{packed.name}: force '{force.name}': {what}"):
                ready = law.as_load(start, end) if isinstance(law, Motion) else law
                laws.append(ready.compiled(start, end))
                tell_missed(f"{packed.name}: force '{force.name}': {what}", ready)
    return pack_laws(laws) if laws else _NONE


def law_values(packed: Packed, laws: Laws, force: Force, times: np.ndarray) -> dict[str, np.ndarray]:
    """Return (T,) values of the laws of a force at times (T,) (s), by the names of its method's arguments."""
    out = np.zeros((len(force.laws), len(times), 3))
    for k, rows in zip(directory(packed)[force.name].law, out, strict=True):
        tabulate_law(laws, k, np.ascontiguousarray(times, float), rows)
    return {name: rows[:, 0] for name, rows in zip(force.laws, out, strict=True)}


_NONE = pack_laws(())


LAW_STEP = 1e-6
"""Part of its size by which a law's pieces disagree where it jumps."""
BESIDE = 1e-12
"""Distance (of the span) from a jump at which a driven motion is evaluated, clear of its author's functions."""


def disagreeing(own: np.ndarray, order: int, part: float, over: float = 0.0) -> list[float]:
    """Return times at which pieces of a law disagree in a derivative by more than ``part`` of its size.

    The law has the numbers ``own``.

    Within ``over`` (s) if that is given: where the next derivative does.
    """
    rows = own[3:].reshape(-1, 7)
    h = np.diff(rows[:, 0])
    coefficients = rows[:, 1:]
    for _ in range(order):
        coefficients = coefficients[:, 1:] * np.arange(1, coefficients.shape[1])
    size = float(np.abs(coefficients[:, 0]).max())
    if over:
        coefficients, size = coefficients[:, 1:] * np.arange(1, coefficients.shape[1]), size / over
    ends = (coefficients[:-1] * h[:, None] ** np.arange(coefficients.shape[1])).sum(axis=1)
    return rows[1:, 0][np.abs(coefficients[1:, 0] - ends) > part * size].tolist()


def jump_times(packed: Packed, laws: Laws, start: float, end: float) -> dict[float, tuple[str, ...]]:
    """Return times (s) between ``start`` and ``end`` of possible jumps, with their drivers and forces.

    For functions of the user, the breaks that were given count.
    """
    jumping: dict[float, dict[str, None]] = {}
    names = [(name, 2) for name in packed.driver_names]
    names += [(force.name, 0) for force in packed.forces for _ in force.laws]
    given = [(float(t), force.name) for force in packed.forces for t in force.params.get("breaks", ())]
    for k, (name, order) in enumerate(names, start=1):
        if laws.kind[k] == PIECES:
            own = laws.numbers[laws.first[k] : laws.first[k + 1]]
            given += [(t, name) for t in disagreeing(own, order, LAW_STEP)]
    for t, name in given:
        if start < t < end:
            jumping.setdefault(t, {})[name] = None
    return {t: tuple(jumping[t]) for t in sorted(jumping)}


def reach_beside(start: float, end: float) -> float:
    """Return how far (s) from a jump a driven motion from ``start`` to ``end`` (s) is evaluated."""
    return BESIDE * (end - start) + finest(start, end)


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
                "too large to resolve a position within the turn. End the motion earlier, or let the law repeat"
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
