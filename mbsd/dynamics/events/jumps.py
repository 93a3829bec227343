"""Jumps where contacts close, open, slide or stick: impacts, then the state of each contact from now on.

By Poisson's law with Coulomb friction in both phases of an impact:

    compression   0 <= N_c  complementary to  g' >= 0,    |T_c| <= mu N_c
    expansion     N_e = e N_c + N,  0 <= N complementary to g' >= 0,   |T_e| <= mu N_e

For one contact without friction this is Newton's law, g'+ = -e g'-. Impacts pass on in rounds: a round takes the
contacts that approach, all at once; those that approach by its impulses are the next round, as in Newton's cradle.
Where there are outlines, contacts struck again and again without rebound, as of a pawl in a corner, push in all
further rounds.
Friction of joints is left out of impacts. Then contacts that do not separate push so that gaps do not close, and slide
or stick as joints may (sticking/deciding.py). A rebound too slow to count ends here: its rate must not go on into
accelerations, which would turn bodies that two contacts hold.

Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts, ch. 8; Glocker, Simulation von harten
Kontakten, on rounds and on laws that keep the energy from growing (sure where all coefficients of restitution in a
round are equal).
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal, kernel
from mbsd.dynamics.events import arrays, rows
from mbsd.dynamics.events.friction import note_met, one_by_one, slide_or_stick, solve_with_friction
from mbsd.dynamics.events.outlines import keep_pairs
from mbsd.dynamics.events.sticking.deciding import decide
from mbsd.dynamics.events.sticking.sharing import stand
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.state import TIME
from mbsd.equations.joint_friction import SENSE

ROUNDS = 200
"""Rounds of an impact; after so many, all closed contacts are solved at once without rebound."""
AGAIN = 3
"""Times that a contact is struck without rebound in an impact, after which it pushes with the others, of outlines."""
CREEP = 1e-6
"""Part of the rates that count as zero, beyond which a contact that carries nothing still closes."""

CLOSE = 1e2
"""Gaps that are closed with another, in those that count as zero."""


@internal
def take_ways(contacts, flags):
    """Put the ways of contacts in ``flags`` (c,) there as well, and none of joints."""
    gap = contacts.friction.gap
    gaps = rows.gaps_of(contacts)
    for k in range(gaps, flags.shape[0]):
        flags[k] = flags[gap[k - gaps]] if k - gaps < gap.shape[0] else 0


@internal
def find_touching(scratch, contacts, met):
    """Fill chosen[TOUCHING] with the gaps that are closed, of ``met`` at any rate; returns how many."""
    gap = contacts.friction.gap
    gaps = rows.gaps_of(contacts)
    struck = gap[met - gaps] if gaps <= met < gaps + gap.shape[0] else met
    touching = 0
    for k in range(gaps):
        near = scratch.ws.phi[contacts.place[k, arrays.ROW]] <= CLOSE * contacts.number[k, arrays.NEAR]
        clutch = contacts.place[k, arrays.KIND] == arrays.CLUTCH
        contacts.chosen[arrays.TOUCHING, k] = 1 if near or k == struck or clutch else 0
        touching += contacts.chosen[arrays.TOUCHING, k]
    take_ways(contacts, contacts.chosen[arrays.TOUCHING])
    return touching


@internal
def find_staying(contacts, opens):
    """Fill chosen[STAYING] with the touching gaps that do not separate by vector[RATE]; returns how many.

    ``opens``: the gap that has just opened, -1 if none has.
    """
    staying = 0
    for k in range(rows.gaps_of(contacts)):
        slow = contacts.vector[arrays.RATE, k] <= max(
            contacts.number[k, arrays.SETTLE], contacts.number[k, arrays.REST]
        )
        contacts.chosen[arrays.STAYING, k] = (
            1 if contacts.chosen[arrays.TOUCHING, k] != 0 and slow and k != opens else 0
        )
        staying += contacts.chosen[arrays.STAYING, k]
    take_ways(contacts, contacts.chosen[arrays.STAYING])
    return staying


@apart
def _strike(dyn, scratch, contacts, v):
    """Let the contacts in chosen[TOUCHING] that approach push, in rounds; returns False where none can."""
    count = contacts.place.shape[0]
    friction = contacts.friction
    gaps = rows.gaps_of(contacts)
    taking = contacts.chosen[arrays.TAKING]
    vector = contacts.vector
    normal = vector[arrays.NORMAL]
    struck = contacts.chosen[arrays.STRUCK]
    most = AGAIN if contacts.outlines.shape[0] > 0 else ROUNDS
    for k in range(count):
        struck[k] = 0
        if k >= gaps:
            vector[arrays.GIVEN, k] = 0.0
    for turn in range(ROUNDS + 1):
        rows.find_rates(dyn, scratch, contacts, v)
        approaching = False
        for k in range(gaps):
            fast = (
                contacts.chosen[arrays.TOUCHING, k] != 0 and vector[arrays.RATE, k] < -contacts.number[k, arrays.REST]
            )
            taking[k] = 1 if fast else 0
            approaching = approaching or fast
        if not approaching:
            return True
        last = turn == ROUNDS
        bounces = False
        for k in range(gaps):
            if last:
                taking[k] = contacts.chosen[arrays.TOUCHING, k]
            rebound = -vector[arrays.RATE, k] * contacts.number[k, arrays.RESTITUTION]
            none = last or rebound < contacts.number[k, arrays.SETTLE]
            vector[arrays.GIVEN, k] = 0.0 if none else contacts.number[k, arrays.RESTITUTION]
            bounces = bounces or (taking[k] != 0 and vector[arrays.GIVEN, k] != 0.0)
        for k in range(gaps):
            if struck[k] >= most and not bounces:
                taking[k] = 1
            elif taking[k] != 0 and vector[arrays.GIVEN, k] == 0.0:
                struck[k] += 1
        take_ways(contacts, taking)
        for w in range(friction.gap.shape[0]):
            friction.number[w, arrays.BESIDE] = 0.0
        if not solve_with_friction(contacts, contacts.compliance, vector[arrays.RATE], arrays.KINETIC, normal):
            return False
        rows.give(contacts, v, vector[arrays.NORMAL])
        since = int(contacts.clock[arrays.LOGGED])
        _log_pushes(contacts, since)
        if not bounces:
            continue
        for k in range(gaps):
            vector[arrays.GIVEN, k] *= vector[arrays.NORMAL, k]
        for w in range(friction.gap.shape[0]):
            friction.number[w, arrays.BESIDE] = (
                friction.number[w, arrays.KINETIC] * vector[arrays.GIVEN, friction.gap[w]]
            )
        rows.find_rates(dyn, scratch, contacts, v)
        for k in range(count):
            for j in range(gaps):
                if taking[k] != 0 and taking[j] != 0:
                    vector[arrays.RATE, k] += contacts.compliance[k, j] * vector[arrays.GIVEN, j]
        if not solve_with_friction(contacts, contacts.compliance, vector[arrays.RATE], arrays.KINETIC, normal):
            return False
        for k in range(count):
            vector[arrays.PUSH, k] = vector[arrays.GIVEN, k] + vector[arrays.NORMAL, k]
        rows.give(contacts, v, vector[arrays.PUSH])
        for i in range(since, int(contacts.clock[arrays.LOGGED])):
            contacts.log[i, 1] += vector[arrays.PUSH, int(contacts.log[i, 0])]
    return True


@internal
def _log_pushes(contacts, since):
    """Write the impulses of a round in vector[NORMAL] to the log, behind its first ``since`` rows."""
    if contacts.log.shape[0] == 0:
        return
    for k in range(rows.gaps_of(contacts)):
        if contacts.chosen[arrays.TAKING, k] != 0:
            contacts.log[since, 0] = k
            contacts.log[since, 1] = contacts.vector[arrays.NORMAL, k]
            since += 1
    contacts.clock[arrays.LOGGED] = since


@internal
def _kinetic_energy(dyn, v):
    energy = 0.0
    for c in range(v.shape[0]):
        energy += dyn.inertia[c] * v[c] ** 2
    return 0.5 * energy


@internal
def impacts(dyn, scratch, contacts, v):
    """Change velocities v (3 nb,) by the impacts of the contacts in chosen[TOUCHING]; False where none are possible."""
    before = _kinetic_energy(dyn, v)
    if not _strike(dyn, scratch, contacts, v):
        return False
    contacts.clock[arrays.ENERGY] = _kinetic_energy(dyn, v) - before
    return True


@internal
def _any_joint(contacts):
    """Return True if there is a joint that may stick and that no event has released."""
    there = False
    for k in range(contacts.place.shape[0] - contacts.sticks.joint.shape[0], contacts.place.shape[0]):
        there = there or contacts.number[k, arrays.RELEASED] == 0.0
    return there


@internal
def _settle(dyn, scratch, contacts, state, staying, halted, slipping, touched):
    """Decide, and again once the ``staying`` gaps that hold are at rest; returns False where nothing is possible."""
    if staying == 0 and not _any_joint(contacts):
        for k in range(contacts.place.shape[0]):
            contacts.vector[arrays.NORMAL, k] = 0.0
        return True
    if not decide(dyn, scratch, contacts, state, halted, slipping, touched):
        return False
    for _ in range(staying):
        if not moving(dyn, scratch, contacts, state.y[1]):
            return True
        rows.stop(dyn, scratch, contacts, state.y[1])
        if not decide(dyn, scratch, contacts, state, halted, slipping, touched):
            return False
    return True


@internal
def _hold_decided(dyn, scratch, contacts):
    """Let rows hold as was decided."""
    count = contacts.place.shape[0]
    number = contacts.number
    taking = contacts.chosen[arrays.TAKING]
    joints = count - contacts.sticks.joint.shape[0]
    gaps = rows.gaps_of(contacts)
    for k in range(gaps):
        taking[k] = 1 if contacts.vector[arrays.NORMAL, k] > 0.0 else 0
        number[k, arrays.CLOSED] = 1.0 * taking[k]
        if taking[k] != 0 and contacts.place[k, arrays.KIND] == arrays.CLUTCH:
            rows.move_zero(scratch, contacts, k)
    slide_or_stick(scratch, contacts)
    for k in range(joints, count):
        taking[k] = 0
        if number[k, arrays.RELEASED] != 0.0:
            continue
        taking[k] = 1 if number[k, arrays.SIGN] == 0.0 else 0
        dyn.loads.friction_number[contacts.place[k, arrays.FRICTION], SENSE] = number[k, arrays.SIGN]
        if taking[k] != 0 and number[k, arrays.CLOSED] == 0.0:
            rows.move_zero(scratch, contacts, k)
        number[k, arrays.CLOSED] = 1.0 * taking[k]
    rows.keep_independent(contacts, taking)
    sharing = False
    mixed = False
    alone = contacts.sticks.borne.shape[0] == 0 or one_by_one(contacts)
    for k in range(count):
        number[k, arrays.HELD] = 1.0 * contacts.chosen[arrays.KEPT, k]
        if k >= gaps and taking[k] != 0:
            sharing = sharing or (number[k, arrays.HELD] == 0.0 and (k >= joints or not alone))
            mixed = mixed or k < joints
    contacts.clock[arrays.SHARING] = (arrays.TOGETHER if mixed else arrays.JOINTS) if sharing else arrays.APART
    rows.hold_rows(dyn, contacts)


@apart
def resolve(dyn, scratch, contacts, state, met):
    """Resolve impacts, and decide what contacts and joints do after row ``met`` came to an event; -1: at the start.

    Returns False where that is impossible; refusals.py says why.
    """
    chosen = contacts.chosen
    v = state.y[1]
    closed = met >= 0 and contacts.number[met, arrays.CLOSED] > 0.0
    joint = met >= 0 and contacts.place[met, arrays.KIND] == arrays.WAY
    together = (
        closed
        and contacts.place[met, arrays.KIND] == arrays.SLIDE
        and contacts.clock[arrays.SHARING] == arrays.TOGETHER
    )
    note_met(contacts, -1 if together else met, state.lam)
    rows.release_rows(dyn, contacts)
    stand(dyn, scratch, contacts, state.clock[TIME], state.y)
    touching = find_touching(scratch, contacts, met)
    for k in range(contacts.place.shape[0]):
        way = contacts.place[k, arrays.KIND] == arrays.WAY and contacts.number[k, arrays.RELEASED] == 0.0
        chosen[arrays.TAKING, k] = 1 if chosen[arrays.TOUCHING, k] != 0 or way else 0
    rows.find_answers(dyn, scratch, contacts, chosen[arrays.TAKING])
    if touching > 0 and not impacts(dyn, scratch, contacts, v):
        return False
    rows.find_rates(dyn, scratch, contacts, v)
    staying = find_staying(contacts, met if closed else -1)
    halted = met if joint and not closed else -1
    slipping = (joint and closed) or together
    touched = met if met >= 0 and contacts.place[met, arrays.KIND] == arrays.GAP and not closed else -1
    if not _settle(dyn, scratch, contacts, state, staying, halted, slipping, touched):
        return False
    _hold_decided(dyn, scratch, contacts)
    keep_pairs(dyn, scratch, contacts, state.clock[TIME], state.y[0])
    return True


@internal
def moving(dyn, scratch, contacts, v):
    """Return True if contacts that hold still move, or others creep; then chosen[KEPT] are the rows to be stopped.

    Joints that stick are among them.
    """
    moving = False
    rows.find_rates(dyn, scratch, contacts, v)
    gap = contacts.friction.gap
    gaps = rows.gaps_of(contacts)
    for k in range(gaps):
        holds = contacts.vector[arrays.NORMAL, k] > 0.0
        rate, rest = contacts.vector[arrays.RATE, k], contacts.number[k, arrays.REST]
        creeps = contacts.chosen[arrays.STAYING, k] != 0 and not holds and rate < -CREEP * rest
        contacts.chosen[arrays.TAKING, k] = 1 if holds or creeps else 0
        moving = moving or creeps or (holds and abs(rate) > rest)
    for w in range(gap.shape[0]):
        p = gaps + w
        rests = (
            contacts.vector[arrays.NORMAL, gap[w]] > 0.0
            and abs(contacts.vector[arrays.RATE, p]) <= contacts.number[p, arrays.REST]
        )
        contacts.chosen[arrays.TAKING, p] = 1 if rests else 0
    for k in range(gaps + gap.shape[0], contacts.place.shape[0]):
        sticks = contacts.number[k, arrays.SIGN] == 0.0 and contacts.number[k, arrays.RELEASED] == 0.0
        contacts.chosen[arrays.TAKING, k] = 1 if sticks else 0
    if moving:
        rows.keep_independent(contacts, contacts.chosen[arrays.TAKING])
    return moving


@kernel
def strike(dyn, scratch, contacts, t, y):
    """Change velocities y[1] by the impacts of the contacts in chosen[TOUCHING]; False where none are possible."""
    rows.release_rows(dyn, contacts)
    take_ways(contacts, contacts.chosen[arrays.TOUCHING])
    derivative(dyn, scratch, t, y, contacts.rates, contacts.lam)
    rows.find_answers(dyn, scratch, contacts, contacts.chosen[arrays.TOUCHING])
    return impacts(dyn, scratch, contacts, y[1])
