"""Normal forces and friction of closed contacts and of joints that stick, as a linear complementarity problem.

In accelerations, or in velocities for impulses; without N and T gaps open with g, ways go on with s:

    0 <= N complementary to g + G_n N + G_nt T >= 0;    |T| <= mu N + L, and the way rests or goes against T

in N, T = T+ - T-, and the slack l of the friction limit:

    w  = G_n N + G_nt T + g                  w+ = G_tn N + G_t T + l + s
    w_l = mu N + L - T+ - T-                 w- = -(G_tn N + G_t T) + l - s

L is the limit of friction of a joint, whose normal force is none of N.

Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts, ch. 5; Stewart, Trinkle 1996, Int. J. Numer.
Meth. Eng. 39.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.base.errors import SimulationError
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.lcp import lemke
from mbsd.dynamics.rows.switches import RunContact

STIFF = 1e-12
"""Compliance of a row, as part of that of its bodies alone, below which nothing gives way."""


def complementarity(
    at: Compliance,
    taking: Sequence[RunContact],
    ways: Sequence[int],
    compliance: np.ndarray,
    rates: np.ndarray,
    pick: np.ndarray,
    limits: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """N (c,) and T (k,) for the gaps of ``taking`` and the rows ``ways``. Raises SimulationError if there are none.

    ``compliance`` (c + k, c + k) and ``rates`` (c + k,) are those of gaps and ways without N and T; the limit of
    friction is ``pick`` (k, c) N + ``limits`` (k,).
    """
    refuse_driven(at, taking, compliance)
    c, k = len(taking), len(ways)
    n, t = slice(0, c), slice(c, c + k)
    unit = 1.0 / np.sqrt(alone(at, [*(contact.gap for contact in taking), *ways]))
    g = compliance * unit * unit[:, None]
    size = float(np.abs(np.diag(g)).max(initial=0.0)) or 1.0
    g /= size
    pick, limits = pick * unit[n] / unit[t, None], limits / unit[t]
    rates = rates * unit
    fastest = float(np.abs(rates).max(initial=0.0)) or 1.0
    b = rates / fastest
    unity = np.eye(k)
    matrix = np.block(
        [
            [g[n, n], g[n, t], -g[n, t], np.zeros((c, k))],
            [g[t, n], g[t, t], -g[t, t], unity],
            [-g[t, n], -g[t, t], g[t, t], unity],
            [pick, -unity, -unity, np.zeros((k, k))],
        ]
    )
    z = lemke(matrix, np.concatenate([b[n], b[t], -b[t], limits * size / fastest]))
    if z is None:
        raise jammed(at, taking)
    z *= fastest / size
    return z[:c] * unit[n], (z[c : c + k] - z[c + k : c + 2 * k]) * unit[t]


def jammed(at: Compliance, taking: Sequence[RunContact]) -> SimulationError:
    """Return the error of contacts with friction that have no forces."""
    frictions = ", ".join(f"{contact.friction:.4g}" for contact in taking)
    return _paradox(at, taking, f" with friction {frictions}" if taking else "")


def _paradox(at: Compliance, taking: Sequence[RunContact], why: str) -> SimulationError:
    """The error where rigid bodies with Coulomb's friction have no motion; ``taking``: the contacts that jam."""
    names = [f"'{contact.name}'" for contact in taking]
    what = "joints that stick jam"
    if names:
        what = f"contact {names[0]} jams" if len(names) == 1 else f"contacts {' and '.join(names)} jam"
    return SimulationError(
        f"{at.packed.name}: at t = {at.time:.6g} s {what}{why}. This is Painleve's paradox: with rigid bodies and "
        "Coulomb's friction the equations of motion have no solution in this pose, whatever the step or the method. "
        "Take less friction, or a contact that yields: m.contact(...) in place of m.rigid_contact(...), see "
        "docs/events.md."
    )


def alone(at: Compliance, rows: Sequence[int]) -> np.ndarray:
    """(k,) compliance of rows that their bodies would have without joints."""
    out = at.dynamics.inverse[3:] @ at.generalised(rows) ** 2
    return np.where(out > 0.0, out, 1.0)


def gives_way(at: Compliance, row: int, compliance: float) -> bool:
    """Whether a force along ``row`` moves anything, its compliance with the joints being ``compliance``."""
    return compliance > STIFF * float(alone(at, [row])[0])


def refuse_driven(at: Compliance, taking: Sequence[RunContact], compliance: np.ndarray) -> None:
    """Raise SimulationError for a contact that no force can open: joints and drivers alone decide its gap, or its friction undoes what it pushes.

    While it slides its compliance is  G_nn - mu G_nt, which is not positive from the friction  mu = G_nn / G_nt  on.
    """
    for k, contact in enumerate(taking):
        if gives_way(at, contact.gap, compliance[k, k]):
            continue
        direction = at.generalised([contact.gap])
        own = float((direction.T @ at.answer(direction))[0, 0])
        if contact.friction and gives_way(at, contact.gap, own):
            critical = contact.friction * own / (own - compliance[k, k])
            why = f": its friction {contact.friction:.4g} is above {critical:.4g}, from which on sliding this way "
            raise _paradox(at, [contact], why + "its own normal force presses the bodies together")
        raise SimulationError(
            f"{at.packed.name}: at t = {at.time:.6g} s joints and drivers move '{contact.name}' against its stop, "
            "and nothing can give way. Drive less far, move the stop, or put a spring between."
        )
