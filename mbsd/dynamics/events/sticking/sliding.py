"""Friction of joints that slide beside others at rest, where these share what holds them.

The rows that hold say what the motion is, and with it the friction of joints that slide. What is at rest may carry
otherwise than they say, and then presses the sliding joints otherwise. Whether it holds is therefore asked with the
friction that belongs to the forces by which it holds,

    T_raw(x) = T_raw + Y (x - x_0),   G_rr Y = - J_r a_x        r: rows that hold

x (f,) normal forces of all joints with friction, x_0 those of the rows that hold; a_x (n, f) accelerations by the
friction of joints that slide under unit normal forces. All is linear in x.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.arrays import BASIS, FOUND, NOW
from mbsd.dynamics.formulation import along, respond
from mbsd.dynamics.reference.sliding import slide
from mbsd.equations.joint_friction import apply_friction, normal_forces
from mbsd.equations.products import eliminate


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
