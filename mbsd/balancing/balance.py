"""Counterweights and balance shafts with which a machine shakes least along a known motion.

    found = balance(m.sweep(steps=360), [Counterweight(crank.start, radius=0.05)])
    found.weights[0].mass, found.weights[0].angle, found.before["force"], found.after["force"]
    found.apply()                                          # the bodies of m carry them from now on

The motion stays what it is, so it must be one that drivers give. Source: Berkof, Lowen, A new method for completely
force balancing simple linkages, 1969; Norton, Design of Machinery, ch. 12.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from mbsd.arrays.inertias import inertia_of
from mbsd.balancing.effects import QUANTITIES, effect_of_shaft, effect_of_weight
from mbsd.balancing.least import least_mean_square, least_peak
from mbsd.balancing.means import BalanceShaft, Counterweight
from mbsd.base.arguments import finite_number, number_pair, positive_number
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, no_such
from mbsd.base.quantity import written
from mbsd.model.body import Body
from mbsd.results.orders import crank_of
from mbsd.results.shaking import planes_of

ROUNDING = 1e-9
"""Part of the sum of all shares below which a quantity is rounding."""


@dataclass(frozen=True)
class Weight:
    """A counterweight that was found: its mass (kg), direction (rad) and place (m) in the body's frame."""

    body: str
    mass: float
    angle: float
    x: float
    y: float
    z: float


@dataclass(frozen=True)
class Shaft:
    """A balance shaft: mass times radius (kg m), and direction (rad) where the crank's angle is 0."""

    ratio: float
    moment: float
    phase: float
    at: tuple[float, float]
    z: float


@dataclass(frozen=True, eq=False)
class Balance(Suggesting):
    """Weights and shafts that balance a mechanism.

    ``before`` and ``after`` are by quantity, RMS or peak (N, N m).
    """

    weights: tuple[Weight, ...]
    shafts: tuple[Shaft, ...]
    norm: str
    before: Mapping[str, float]
    after: Mapping[str, float]
    series: Mapping[str, np.ndarray]
    """Quantities (T,) or (T, 2) by name, with the weights and shafts."""
    mechanism: Any

    def apply(self) -> None:
        """Put the counterweights on the bodies of the mechanism.

        Mass, centre of mass, inertia and products follow. Balance shafts are bodies of their own, which the author adds
        where there is room for them.
        """
        for weight in self.weights:
            _carry(self.mechanism.bodies[weight.body], weight)

    def __str__(self) -> str:
        lines = [f"{name}: {self.norm} {self.before[name]:.4g} -> {self.after[name]:.4g}" for name in self.before]
        lines += [
            f"{w.body}: {written(w.mass, 'kg', 4)} at ({w.x:.4g}, {w.y:.4g}) m" + (f", z {w.z:.4g} m" if w.z else "")
            for w in self.weights
        ]
        lines += [
            f"shaft of ratio {s.ratio:g}: {s.moment:.4g} kg m at {math.degrees(s.phase):.4g} degrees"
            for s in self.shafts
        ]
        return "\n".join(lines)


def balance(
    sol: Any,
    means: Sequence[Counterweight | BalanceShaft],
    of: str | Mapping[str, float] = "force",
    norm: Literal["rms", "peak"] = "rms",
    about: tuple[float, float] = (0.0, 0.0),
    z: float = 0.0,
    crank: str | None = None,
) -> Balance:
    """The masses and directions of ``means`` with which a quantity of the motion ``sol`` is least.

    ``of``: "force", "moment", "couple" (what inertia does to the frame, as in ``sol.shaking(about, z)``) or "torque"
    (the unevenness of the driver's effort); several by a mapping to their weights, each counted in parts of what it is
    without them. One that is zero without them, but for rounding, counts in parts of what it would be if the shares of
    all bodies pointed the same way. ``norm``: root mean square over time, or peak. ``crank`` turns the balance shafts;
    by default that of ``sol.orders``. Raises ModelError for what is no such thing, for a simulation, where the motion
    would change, and for a torque without exactly one driver.
    """
    m = sol.mechanism
    wanted = _wanted(m.name, of)
    if norm not in ("rms", "peak"):
        raise ModelError(f"{m.name}: balance: norm is {norm!r}; it is 'rms' or 'peak'")
    if not means or not all(isinstance(mass, Counterweight | BalanceShaft) for mass in means):
        raise ModelError(f"{m.name}: balance: give a list of Counterweight(...) and BalanceShaft(...)")
    if sol.work is not None:
        raise ModelError(f"{m.name}: balance: masses would change a motion that forces make; give one of sweep()")
    for mass in means:
        if isinstance(mass, Counterweight) and m.bodies.get(mass.body) is not mass.about.body:
            raise ModelError(f"{m.name}: balance: the counterweight on '{mass.body}' is on a body of another mechanism")
    place, z0 = number_pair(f"{m.name}: balance: about", about), finite_number(f"{m.name}: balance: z", z)
    shafts = any(isinstance(mass, BalanceShaft) for mass in means)
    turned_by = (crank_of(sol) if crank is None else crank) if shafts else ""
    effects = [
        effect_of_weight(sol, mass, place, z0)
        if isinstance(mass, Counterweight)
        else effect_of_shaft(sol, mass, turned_by, place, z0)
        for mass in means
    ]
    given = {name: _given(sol, name, place, z0) for name in wanted}
    rate = _rate(sol, wanted)
    added = {name: np.stack([effect.on(name, rate) for effect in effects], axis=2) for name in wanted}
    if "torque" in wanted:
        added["torque"] = added["torque"] - added["torque"].mean(axis=0)
    shares = _shares(sol.t)
    parts = {name: _measure(_unbalanced(sol, name, place, z0), norm, shares) for name in wanted}
    scales = {}
    for name, weight in wanted.items():
        own = _measure(given[name], norm, shares)
        scales[name] = weight / ((own if own > ROUNDING * parts[name] else parts[name]) or 1.0)
    u = _search(given, added, scales, norm, np.array([mass.largest for mass in means]), shares)
    full = np.concatenate([u, np.hypot(*u.T)[:, None]], axis=1)
    series = {name: given[name] + np.einsum("tckj,kj->tc", added[name], full) for name in wanted}
    return Balance(
        tuple(_weight(mass, v) for mass, v in zip(means, u, strict=True) if isinstance(mass, Counterweight)),
        tuple(_shaft(mass, v) for mass, v in zip(means, u, strict=True) if isinstance(mass, BalanceShaft)),
        norm,
        {name: _measure(given[name], norm, shares) for name in wanted},
        {name: _measure(series[name], norm, shares) for name in wanted},
        {name: values if values.shape[1] > 1 else values[:, 0] for name, values in series.items()},
        m,
    )


def _wanted(name: str, of: str | Mapping[str, float]) -> dict[str, float]:
    asked = {of: 1.0} if isinstance(of, str) else dict(of)
    for key, weight in asked.items():
        if key not in QUANTITIES:
            raise ModelError(f"{name}: balance: {no_such('quantity', str(key), QUANTITIES)}")
        positive_number(f"{name}: balance: weight of {key}", weight)
    if not asked:
        raise ModelError(f"{name}: balance: nothing is to be made least; there is {', '.join(QUANTITIES)}")
    return asked


def _given(sol: Any, quantity: str, about: tuple[float, float], z0: float) -> np.ndarray:
    """(T, k) without what is added."""
    if quantity == "torque":
        effort = sol.driver(_driver(sol)).effort
        return (effort - effort.mean())[:, None]
    shaking = sol.shaking(about, z0)
    values = {"force": shaking.force, "moment": shaking.moment[:, None], "couple": shaking.couple}
    return values[quantity]


def _unbalanced(sol: Any, quantity: str, about: tuple[float, float], z0: float) -> np.ndarray:
    """(T, 1) what it would be if the shares of all bodies added up."""
    inertia, planes = inertia_of(sol.packed).reshape(-1, 3)[1:], planes_of(sol.mechanism.bodies.values())
    q, v, push = sol.q[:, 1:], sol.v[:, 1:], np.abs(inertia * sol.a[:, 1:])
    force = np.hypot(push[..., 0], push[..., 1])
    if quantity == "force":
        each = force
    elif quantity == "moment":
        each = np.hypot(*np.moveaxis(q[..., :2] - np.asarray(about), -1, 0)) * force + push[..., 2]
    elif quantity == "couple":
        turning = v[..., 2] ** 2 + np.abs(sol.a[:, 1:, 2])
        each = np.abs(planes.z - z0) * force + np.hypot(*planes.products.T) * turning
    else:
        weight = inertia[:, :2] * np.asarray(sol.packed.system.gravity)
        power = (push * np.abs(v)).sum(axis=-1) + (np.abs(weight) * np.abs(v[..., :2])).sum(axis=-1)
        each = power / np.abs(sol.driver(_driver(sol)).rate)[:, None]
    return each.sum(axis=1)[:, None]


def _driver(sol: Any) -> str:
    names = list(sol.mechanism.drivers)
    if len(names) != 1:
        raise ModelError(
            f"{sol.mechanism.name}: balance: torque is that of one driver, and there are {len(names)}"
            + (f": {', '.join(names)}" if names else "")
        )
    return names[0]


def _rate(sol: Any, wanted: Mapping[str, float]) -> np.ndarray:
    if "torque" not in wanted:
        return np.ones(len(sol.t))
    rate = sol.driver(_driver(sol)).rate
    if (np.abs(rate) < 1e-9 * np.abs(rate).max(initial=0.0)).any() or not rate.any():
        raise ModelError(
            f"{sol.mechanism.name}: balance: the driver '{_driver(sol)}' stands still at times, where no effort "
            "follows from power; leave these times out"
        )
    return rate


def _search(
    given: Mapping[str, np.ndarray],
    added: Mapping[str, np.ndarray],
    scales: Mapping[str, float],
    norm: str,
    bounds: np.ndarray,
    shares: np.ndarray,
) -> np.ndarray:
    """(K, 2) vectors of the means; ``scales`` weigh the quantities."""
    b = np.concatenate([(scale * given[name]).ravel() for name, scale in scales.items()])
    count = len(bounds)
    columns = np.concatenate([scale * added[name].reshape(-1, count, 3) for name, scale in scales.items()])
    root = np.sqrt(np.concatenate([np.repeat(shares, given[name].shape[1]) for name in scales]))
    u = least_mean_square(root * b, root[:, None, None] * columns, bounds)
    if norm == "rms":
        return u
    # A time of a vector's components is one group; quantities are compared by their own peaks.
    groups, first = [], 0
    for name in scales:
        rows, width = given[name].shape
        groups.append(first + np.repeat(np.arange(rows), width))
        first += rows
    return least_peak(b, columns, bounds, np.concatenate(groups), u)


def _measure(values: np.ndarray, norm: str, shares: np.ndarray) -> float:
    """Root mean square over time, or largest, of (T, k) rows."""
    squares = (values**2).sum(axis=1)
    return math.sqrt(float(squares @ shares if norm == "rms" else squares.max()))


def _shares(t: np.ndarray) -> np.ndarray:
    """Return (T,) weights of the trapezoidal rule, whose sum is 1.

    Over a whole period the rule is exact for all low harmonics.
    """
    if len(t) < 2:
        return np.ones(len(t))
    gaps = np.diff(t)
    return np.append(gaps, 0.0) / (2 * (t[-1] - t[0])) + np.insert(gaps, 0, 0.0) / (2 * (t[-1] - t[0]))


def _weight(counterweight: Counterweight, u: np.ndarray) -> Weight:
    mass, angle = float(np.hypot(*u)), math.atan2(u[1], u[0])
    x, y = (
        counterweight.about.x + counterweight.radius * math.cos(angle),
        counterweight.about.y + counterweight.radius * math.sin(angle),
    )
    return Weight(counterweight.body, mass, angle, x, y, counterweight.plane)


def _shaft(balance_shaft: BalanceShaft, u: np.ndarray) -> Shaft:
    return Shaft(balance_shaft.ratio, float(np.hypot(*u)), math.atan2(u[1], u[0]), balance_shaft.at, balance_shaft.z)


def _carry(body: Body, weight: Weight) -> None:
    """Add a point mass to a body: parallel axes about the common centre of mass."""
    total = body.mass + weight.mass
    if total == 0.0:
        return
    share = weight.mass / total
    dx, dy, dz = weight.x - body.com[0], weight.y - body.com[1], weight.z - (body.z or 0.0)
    reduced = body.mass * share
    com = body.com[0] + share * dx, body.com[1] + share * dy
    products = body.products[0] + reduced * dx * dz, body.products[1] + reduced * dy * dz
    inertia = body.inertia + reduced * (dx**2 + dy**2)
    body.mass, body.com, body.inertia, body.products = total, com, inertia, products
    if dz != 0.0:
        body.z = (body.z or 0.0) + share * dz
