"""Responses of a mechanism to forces at a pose, with joints and drivers holding and all switched rows released.

    M a + J^T lam = Q,   J a = gamma          M dv + J^T p = impulse,   J dv = 0

By the factors of dynamics/reference/acceleration.py.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.events.arrays import BLOCK, HELD, SIDE
from mbsd.dynamics.events.friction.resting import gives
from mbsd.dynamics.events.pushes import find_answer, read_compliance
from mbsd.dynamics.reference.schur import factor_schur
from mbsd.dynamics.reference.sliding import begin_sliding, slide
from mbsd.equations.assembly import evaluate_gamma, evaluate_position
from mbsd.equations.laws import evaluate_laws


@apart
def stand(dyn, scratch, t, y):
    """Fill scratch.ws and, with the rows that hold now, the factors at a state y (2, 3 nb) and time t (s).

    gamma (m,) is in scratch.ws.right[0].
    """
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    evaluate_position(dyn.system, y[0], scratch.drive, scratch.ws)
    evaluate_gamma(dyn.system, y[1], scratch.drive, scratch.ws, scratch.ws.right[0])
    factor(dyn, scratch)


@apart
def factor(dyn, scratch):
    """Factor the rows that hold now, at the pose of scratch.ws."""
    factor_schur(dyn.schur, dyn.inverse, scratch.ws.jac, scratch.factors, 0.0)


@internal
def find_answers(dyn, scratch, contacts, flags):
    """Fill answer, borne, compliance and vector[ALONE] of the rows in ``flags`` (c,)."""
    for k in range(contacts.place.shape[0]):
        if flags[k] != 0:
            find_answer(dyn, scratch, contacts, k, contacts.sticks.borne[k])
    read_compliance(dyn, scratch, contacts, flags)


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
