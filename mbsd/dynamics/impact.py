"""Laws of contact: how velocities jump in an impact, and what closed contacts do from then on.

Impact, by Poisson's law with Coulomb friction in both phases:

    compression   0 <= N_c  complementary to  g' >= 0,    |T_c| <= mu N_c
    expansion     N_e = e N_c + N,  0 <= N complementary to g' >= 0,   |T_e| <= mu N_e

For one contact without friction this is Newton's law, g'+ = -e g'-. Impacts pass on in rounds: a round takes the
contacts that approach, all at once; those that approach by its impulses are the next round, as in Newton's cradle.

After it, for closed contacts that do not separate, in accelerations:

    0 <= N complementary to g'' >= 0;   sliding: T = -mu N sign(s');   s' = 0: |T| <= mu N, s'' = 0 or against T

Both are linear complementarity problems in N, T = T+ - T-, and the slack l of the friction limit:

    w  = G_n N + G_nt T + g              w+ = G_tn N + G_t T + l + s
    w_l = mu N - T+ - T-                 w- = -(G_tn N + G_t T) + l - s

Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts, ch. 5 and 8; Stewart, Trinkle 1996, Int. J.
Numer. Meth. Eng. 39; Glocker, Simulation von harten Kontakten, on rounds and on laws that keep the energy from growing
(sure where all coefficients of restitution in a round are equal).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.dynamics.compliance import Compliance
from mbsd.dynamics.lcp import lemke
from mbsd.dynamics.switches import Touch
from mbsd.errors import SimulationError

ROUNDS = 200
"""After so many, all closed contacts are solved at once without rebound."""


STIFF = 1e-12
"""Compliance of a contact, as part of that of its bodies alone, below which nothing gives way."""


@dataclass
class Impulse:
    """What a contact gave in an impact."""

    touch: Touch
    normal: float
    """N s, or N m s."""


def impacts(
    at: Compliance, closed: Sequence[Touch], v: np.ndarray, still: np.ndarray
) -> tuple[np.ndarray, list[Impulse]]:
    """Velocities after (3 nb,) and the impulses, in order. ``still`` (m,): rates below this are zero."""
    v, given = v.copy(), []
    for round_number in range(ROUNDS + 1):
        rates = at.rates([touch.gap for touch in closed], v)
        approaching = [touch for touch, rate in zip(closed, rates, strict=True) if rate < -still[touch.gap]]
        if not approaching:
            break
        last = round_number == ROUNDS
        taking = list(closed) if last else approaching
        speeds = at.rates([touch.gap for touch in taking], v)
        bounce = np.array(
            [
                0.0 if last or -rate * touch.restitution < touch.settle else touch.restitution
                for touch, rate in zip(taking, speeds, strict=True)
            ]
        )
        normal, dv = _push(at, taking, v, np.zeros(len(taking)))
        v[3:] += dv
        if bounce.any():
            more, dv = _push(at, taking, v, bounce * normal)
            normal = normal + more
            v[3:] += dv
        given += [Impulse(touch, float(one)) for touch, one in zip(taking, normal, strict=True) if one > 0.0]
    return v, given


def _push(at: Compliance, taking: Sequence[Touch], v: np.ndarray, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One phase: normal impulses (c,), ``given`` ones among them, and the change of velocities (n,)."""
    gaps = [touch.gap for touch in taking]
    rough = [k for k, touch in enumerate(taking) if touch.way is not None]
    ways = [taking[k].way or 0 for k in rough]
    directions = at.generalised([*gaps, *ways])
    answers = at.answer(directions)
    compliance = directions.T @ answers
    rates = at.rates([*gaps, *ways], v) + compliance[:, : len(gaps)] @ given
    friction = np.array([taking[k].friction for k in rough])
    normal, along = complementarity(at, taking, compliance, rates, friction, rough, given)
    return normal + given, answers @ np.concatenate([normal + given, along])


def complementarity(
    at: Compliance,
    taking: Sequence[Touch],
    compliance: np.ndarray,
    rates: np.ndarray,
    friction: np.ndarray,
    rough: Sequence[int],
    given: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """N (c,) and T (k,) for gaps, then ways of the contacts ``rough`` (k,). Raises SimulationError if there are none.

    ``compliance`` (c + k, c + k) and ``rates`` (c + k,) are those of gaps and ways without N and T.
    """
    _refuse_driven(at, taking, compliance)
    c, k = len(taking), len(rough)
    size = float(np.abs(np.diag(compliance)).max())
    g = compliance / size
    fastest = float(np.abs(rates).max()) or 1.0
    n, t = slice(0, c), slice(c, c + k)
    pick = np.zeros((k, c))
    pick[np.arange(k), rough] = friction
    one = np.eye(k)
    matrix = np.block(
        [
            [g[n, n], g[n, t], -g[n, t], np.zeros((c, k))],
            [g[t, n], g[t, t], -g[t, t], one],
            [-g[t, n], -g[t, t], g[t, t], one],
            [pick, -one, -one, np.zeros((k, k))],
        ]
    )
    b = rates / fastest
    limits = pick @ given * size / fastest
    z = lemke(matrix, np.concatenate([b[n], b[t], -b[t], limits]))
    if z is None:
        names = ", ".join(f"'{touch.name}'" for touch in taking)
        raise SimulationError(
            f"{at.packed.name}: at t = {at.time:.6g} s the contacts {names} allow no motion with rigid bodies and this "
            "friction (jamming, Painleve's paradox). Use less friction, or a contact that yields."
        )
    z *= fastest / size
    return z[:c], z[c : c + k] - z[c + k : c + 2 * k]


def _refuse_driven(at: Compliance, taking: Sequence[Touch], compliance: np.ndarray) -> None:
    """A contact that no force can open: joints and drivers alone decide its gap."""
    for k, touch in enumerate(taking):
        free = at.dynamics.inverse[3:] @ at.generalised([touch.gap])[:, 0] ** 2
        if compliance[k, k] <= STIFF * free:
            raise SimulationError(
                f"{at.packed.name}: at t = {at.time:.6g} s joints and drivers move '{touch.name}' against its stop, "
                "and nothing can give way. Drive less far, move the stop, or put a spring between."
            )


@dataclass
class Decision:
    """What a closed contact does from now on."""

    touch: Touch
    normal: float
    """N (N or N m); 0: it opens."""
    sliding: float
    """Sign of the way's rate; 0 where it sticks or has no friction."""


def decide(
    at: Compliance,
    closed: Sequence[Touch],
    v: np.ndarray,
    still: np.ndarray,
    forced: dict[str, float],
) -> list[Decision]:
    """For contacts that neither approach nor separate. ``forced``: contacts by name that leave a sticking point with
    the sign of their sliding."""
    if not closed:
        return []
    a, gamma, largest = at.accelerations(v)
    gaps = [touch.gap for touch in closed]
    all_ways = [touch.way for touch in closed if touch.way is not None]
    speed = dict(zip(all_ways, at.rates(all_ways, v), strict=True))
    sliding = np.zeros(len(closed))
    for k, touch in enumerate(closed):
        if touch.way is not None:
            rate = speed[touch.way]
            sliding[k] = forced.get(touch.name, np.sign(rate) if abs(rate) > still[touch.way] else 0.0)
    rough = [k for k, touch in enumerate(closed) if touch.way is not None and sliding[k] == 0.0]
    ways = [closed[k].way or 0 for k in rough]
    directions = at.generalised([*gaps, *ways])
    pushed = directions.copy()
    for k, touch in enumerate(closed):
        if sliding[k] != 0.0:
            pushed[:, k] -= touch.friction * sliding[k] * at.generalised([touch.way or 0])[:, 0]
    compliance = directions.T @ at.answer(pushed)
    free = directions.T @ a - gamma[[*gaps, *ways]]
    friction = np.array([closed[k].static_friction for k in rough])
    normal, along = complementarity(at, closed, compliance, free, friction, rough, np.zeros(len(closed)))
    out = []
    for k, touch in enumerate(closed):
        holds = normal[k] > 1e-12 * largest
        direction = sliding[k]
        if k in rough and holds:
            force = along[rough.index(k)]
            if abs(force) >= touch.static_friction * normal[k] * (1.0 - 1e-10):
                direction = -float(np.sign(force))
        out.append(Decision(touch, float(normal[k]) if holds else 0.0, direction))
    breaking = {
        one.touch.name: one.sliding
        for k, one in enumerate(out)
        if k in rough and one.sliding != 0.0 and one.touch.static_friction > one.touch.friction
    }
    return decide(at, closed, v, still, forced | breaking) if breaking else out
