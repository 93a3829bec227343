"""Laws of contact: how velocities jump in an impact.

By Poisson's law with Coulomb friction in both phases:

    compression   0 <= N_c  complementary to  g' >= 0,    |T_c| <= mu N_c
    expansion     N_e = e N_c + N,  0 <= N complementary to g' >= 0,   |T_e| <= mu N_e

For one contact without friction this is Newton's law, g'+ = -e g'-. Impacts pass on in rounds: a round takes the
contacts that approach, all at once; those that approach by its impulses are the next round, as in Newton's cradle.
Friction of joints is left out of impacts.

Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts, ch. 8; Glocker, Simulation von harten
Kontakten, on rounds and on laws that keep the energy from growing (sure where all coefficients of restitution in a
round are equal).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.dynamics.events.bounds import ROUNDS
from mbsd.dynamics.events.laws.complementarity import complementarity
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.rows.switches import RunContact


@dataclass
class Impulse:
    """What a contact gave in an impact."""

    contact: RunContact
    normal: float
    """N s, or N m s."""


def impacts(
    at: Compliance, closed: Sequence[RunContact], v: np.ndarray, still: np.ndarray
) -> tuple[np.ndarray, list[Impulse]]:
    """Velocities after (3 nb,) and the impulses, in order. ``still`` (m,): rates below this are zero."""
    v, given = v.copy(), []
    for round_number in range(ROUNDS + 1):
        rates = at.rates([contact.gap for contact in closed], v)
        approaching = [contact for contact, rate in zip(closed, rates, strict=True) if rate < -still[contact.gap]]
        if not approaching:
            break
        last = round_number == ROUNDS
        taking = list(closed) if last else approaching
        speeds = at.rates([contact.gap for contact in taking], v)
        bounce = np.array(
            [
                0.0 if last or -rate * contact.restitution < contact.settle else contact.restitution
                for contact, rate in zip(taking, speeds, strict=True)
            ]
        )
        normal, dv = _push(at, taking, v, np.zeros(len(taking)))
        v[3:] += dv
        if bounce.any():
            more, dv = _push(at, taking, v, bounce * normal)
            normal = normal + more
            v[3:] += dv
        given += [
            Impulse(contact, float(impulse)) for contact, impulse in zip(taking, normal, strict=True) if impulse > 0.0
        ]
    return v, given


def _push(
    at: Compliance, taking: Sequence[RunContact], v: np.ndarray, given: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """One phase: normal impulses (c,), ``given`` ones among them, and the change of velocities (n,)."""
    gaps = [contact.gap for contact in taking]
    rough = [k for k, contact in enumerate(taking) if contact.way is not None]
    ways = [taking[k].way or 0 for k in rough]
    directions = at.generalised([*gaps, *ways])
    answers = at.answer(directions)
    compliance = directions.T @ answers
    rates = at.rates([*gaps, *ways], v) + compliance[:, : len(gaps)] @ given
    pick = np.zeros((len(rough), len(taking)))
    pick[np.arange(len(rough)), rough] = [taking[k].friction for k in rough]
    normal, along = complementarity(at, taking, ways, compliance, rates, pick, pick @ given)
    return normal + given, answers @ np.concatenate([normal + given, along])
