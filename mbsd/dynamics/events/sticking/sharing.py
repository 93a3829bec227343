"""Joints at rest that hold each other: how they and what presses them answer to forces (together.py shares these).

One set of rows holds them, and its multipliers carry all. The friction is shared among all joints at rest
(events/laws/division.py); their limits depend on reactions, which change with the shares, so it is shared again until
both agree. Contacts that are closed react, so that their gaps stay closed, and with them the friction of those that
slide:

    V = V_t - V_h G_h^-1 G_ht,   G = J_t V     h: rows of contacts that hold; the gap of one that slides pushes along
                                               its way too

V (n, k) are accelerations by unit friction T. What contacts hold by themselves no joint needs to. Where contacts slide,
G is not symmetric, and two questions part:

    V d = 0     T may change by d: nothing moves differently. As  V^T M V d = 0  it is one of a symmetric compliance
    G d = 0     joints stay at rest, though what else moves may move differently, as the contacts press more or less

The first is how friction is shared, the second how near joints are to giving way: Coulomb's law asks no more of them.

Responses to forces at a pose, with joints and drivers holding and all switched rows released:

    M a + J^T lam = Q,   J a = gamma          M dv + J^T p = impulse,   J dv = 0

by the factors of dynamics/reference/acceleration.py.

Joints may slide beside those at rest. The rows that hold say what the motion is, and with it the friction of joints
that slide. What is at rest may carry otherwise than they say, and then presses the sliding joints otherwise. Whether
it holds is therefore asked with the friction that belongs to the forces by which it holds,

    T_raw(x) = T_raw + Y (x - x_0),   G_rr Y = - J_r a_x        r: rows that hold

x (f,) normal forces of all joints with friction, x_0 those of the rows that hold; a_x (n, f) accelerations by the
friction of joints that slide under unit normal forces. All is linear in x.
"""

from __future__ import annotations

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.arrays import BASIS, BLOCK, FOUND, HELD, NOW, SIDE
from mbsd.dynamics.events.friction import gives
from mbsd.dynamics.events.rows import find_answer, read_compliance
from mbsd.dynamics.formulation import along, derivative, respond
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.reference.schur import factor_schur
from mbsd.dynamics.reference.sliding import begin_sliding, slide
from mbsd.equations.assembly import evaluate_gamma, evaluate_position
from mbsd.equations.joint_friction import PRELOAD, SHAPE, SIZE, STATIC, apply_friction, normal_forces, turns_about
from mbsd.equations.laws import evaluate_laws
from mbsd.equations.products import eliminate


@apart
def _stand_in_plane(dyn, scratch, contacts, t, y):
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    evaluate_position(dyn.system, y[0], scratch.drive, scratch.ws)
    evaluate_gamma(dyn.system, y[1], scratch.drive, scratch.ws, scratch.ws.right[0])
    factor(dyn, scratch)


@internal
def _stand(dyn, scratch, contacts, t, y):
    derivative(dyn, scratch, t, y, contacts.rates, contacts.lam)


stand = alternatives({Dynamics: _stand_in_plane}, _stand)
"""(dyn, scratch, contacts, t, y): fill scratch.ws and, with the rows that hold now, the factors at a state y (2, 3 + n)
and time t (s). gamma (m,) is in scratch.ws.right[0]. Added formulations evaluate their accelerations."""


@apart
def factor(dyn, scratch):
    """Factor the rows that hold now, at the pose of scratch.ws."""
    factor_schur(dyn.schur, dyn.inverse, scratch.ws.jac, scratch.factors, 0.0)


@internal
def answer_resting(dyn, scratch, contacts, flags):
    """Find answers of joints at rest, in ``flags`` (c,), where contacts hold and react, with their friction.

    The rows of joints are released. What contacts hold by themselves leaves ``flags``.
    """
    count = contacts.place.shape[0]
    joints = count - contacts.sticks.joint.shape[0]
    table = dyn.sliding.table
    held = False
    for k in range(joints):
        held = held or contacts.number[k, HELD] > 0.0
    for k in range(joints, count):
        dyn.schur.rows[contacts.place[k, BLOCK], contacts.place[k, SIDE]] = -1
    factor(dyn, scratch)
    if table.shape[0] > 0:
        begin_sliding(dyn, scratch)
    for k in range(joints, count):
        if flags[k] == 0:
            continue
        find_answer(dyn, scratch, contacts, k, contacts.sticks.borne[k])
        if table.shape[0] > 0:
            for w in range(table.shape[0]):
                table[w, table.shape[1] - 1] = 0.0
            slide(dyn, scratch, contacts.answer[k], contacts.answer[k], contacts.sticks.borne[k])
    read_compliance(dyn, scratch, contacts, flags)
    for k in range(joints, count):
        if held and flags[k] != 0 and not gives(contacts, k):
            flags[k] = 0


@apart
def press_beside(dyn, scratch, contacts, v, lam, reacting):
    """Fill sticks.beside and beside_lam at velocities v (3 nb,); whether any joint slides with friction.

    Factors are those of the rows that react; contacts that slide do so with their friction if ``reacting``. lam (m,)
    are the multipliers of the motion.
    """
    sticks = contacts.sticks
    normal = sticks.normal
    force = contacts.force
    table = dyn.sliding.table
    any_slides = False
    for j in range(normal.shape[1]):
        for k in range(normal.shape[1]):
            normal[NOW, k] = 1.0 if k == j else 0.0
        for c in range(force.shape[0]):
            force[c] = 0.0
        apply_friction(dyn.system, dyn.loads, v, scratch.ws, normal[NOW], 0.0, force)
        for c in range(force.shape[0]):
            if c < 3:
                force[c] = 0.0
            any_slides = any_slides or force[c] != 0.0
        respond(dyn, scratch, force, 0.0, sticks.beside[j], sticks.beside_lam[j])
        if reacting and table.shape[0] > 0:
            for w in range(table.shape[0]):
                table[w, table.shape[1] - 1] = 0.0
            slide(dyn, scratch, sticks.beside[j], sticks.beside[j], sticks.beside_lam[j])
    if any_slides:
        normal_forces(dyn.loads, scratch.ws, scratch.ws.jac, lam, normal[BASIS])
    return any_slides


@internal
def note_beside(dyn, scratch, contacts, i, row):
    """Fill change[i] with the accelerations of a row of J by each of these frictions."""
    sticks = contacts.sticks
    for j in range(sticks.change.shape[1]):
        sticks.change[i, j] = along(dyn, scratch, row, sticks.beside[j])


@internal
def find_changes(contacts, compliance, held, count):
    """Make change (c, f) of these accelerations what forces of rows ``held`` (c,) change by; zero of others."""
    change = contacts.sticks.change
    table = contacts.sticks.together.table
    h = 0
    for i in range(count):
        if held[i] == 0:
            continue
        at = 0
        for j in range(count):
            if held[j] != 0:
                table[h, at] = compliance[i, j]
                at += 1
        for j in range(change.shape[1]):
            change[h, j] = -change[i, j]
        h += 1
    eliminate(table[:h, :h], change[:h])
    for back in range(count):
        i = count - 1 - back
        if held[i] != 0:
            h -= 1
        for j in range(change.shape[1]):
            change[i, j] = change[h, j] if held[i] != 0 else 0.0


@internal
def add_beside(contacts, i, force):
    """Return ``force`` of row i without sharing, with what the present normal forces of joints change of it."""
    sticks = contacts.sticks
    for j in range(sticks.change.shape[1]):
        force += sticks.change[i, j] * (sticks.normal[FOUND, j] - sticks.normal[BASIS, j])
    return force


@internal
def add_beside_lam(contacts, lam):
    """Add to lam (m,) what the present normal forces of joints change of the multipliers of joints and drivers."""
    sticks = contacts.sticks
    for j in range(sticks.change.shape[1]):
        more = sticks.normal[FOUND, j] - sticks.normal[BASIS, j]
        for r in range(lam.shape[0]):
            lam[r] += sticks.beside_lam[j, r] * more


@internal
def limit_of(dyn, k, normal):
    """Return the largest friction (N, N m) of joint k with friction, at rest under normal forces (f,)."""
    number = dyn.loads.friction_number[k]
    lever = number[SIZE] if turns_about(dyn.loads.friction[k, SHAPE]) else 1.0
    return number[STATIC] * lever * (normal[k] + number[PRELOAD])


@internal
def find_moved(dyn, contacts, flags):
    """Fill friction.compliance of the joints in ``flags`` (c,) with V^T M V where contacts slide; whether any does."""
    sliding = False
    for w in range(dyn.sliding.table.shape[0]):
        sliding = sliding or dyn.sliding.table[w, 0] != 0.0
    if not sliding:
        return False
    answer = contacts.answer
    for k in range(flags.shape[0]):
        for j in range(k + 1):
            if flags[k] == 0 or flags[j] == 0:
                continue
            both = 0.0
            for c in range(3, answer.shape[1]):
                both += answer[k, c] * answer[j, c] / dyn.inverse[c]
            contacts.friction.compliance[k, j] = both
            contacts.friction.compliance[j, k] = both
    return True
