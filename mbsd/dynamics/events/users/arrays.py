"""Events of the user as arrays that the compiled loop reads and overwrites; empty where there are none."""

from __future__ import annotations

from typing import Any, NamedTuple

VALUE, FIRST, FRAMES, DIRECTION, ENDS, ACTION, ACTION_FIRST, ACTION_FRAMES = range(8)
"""Columns of Events.table: address of the function; its first frame, and how many it has; rising 1, falling -1, both 0;
whether the simulation ends there; address of the action, 0 where there is none; its frames."""
WHOLE = -1
"""Number of frames of a function that gets all coordinates and velocities."""
BY_PYTHON = -1
"""Address of an action that Python lets act while the loop waits."""
SIDE, LEVEL, SHORTEST, UNKNOWN = range(4)
"""Columns of Events.number: sign of the value, 0 where that is zero; what is taken off the function's number; how long
the shortest thing in it lasts (s), 0 where nothing is said; how many values did not tell how it goes in a
step, 0 while all did."""
GROUP, ROW, BLOCK, SIDE_OF_BLOCK, OPEN_BLOCK, OPEN_SIDE, ITS_FRICTION = range(7)
"""Columns of Events.release: the event, or a number behind all events for a joint that actions in Python may release; a
row of J that is released; its block and its place there in Schur.rows, and
the same without contacts; the row of a friction of its joint in Loads.friction. -1: there is none."""


class Events(NamedTuple):
    """e events with f frames, of a mechanism of nb bodies."""

    table: Any
    """(e, 8) int"""
    number: Any
    """(e, 4)"""
    gone: Any
    """(g,) when (s) each group of rows was released, infinite before."""
    release: Any
    """(r, 7) int"""
    body: Any
    """(f,) int"""
    arm: Any
    """(f, 3) from the centre of mass in the body's axes (m), and angle (rad)."""
    inputs: Any
    """(i,) of a function: places of its frames, then their rates."""
    outputs: Any
    """(o,)"""
    near: Any
    """(4,) parts of the time by which it changes by what counts as nothing."""
    away: Any
    """(4, 3 nb) the same for coordinates and velocities, to be added."""
    span: Any
    """(1,) duration (s)."""
    pose: Any
    """(2, 3 nb)"""
    bend: Any
    """(3 nb,) q'' at a state."""
    parts: Any
    """(n,) parts of a step, rising, at which an event is looked at."""
    values: Any
    """(n,) its values there, with the sign of its side."""
    more: Any
    """(2, n) the same while more are put between them."""
    there: Any
    """(2, n) values in the middle of intervals, and by how much they are not those that neighbours let expect."""
    rough: Any
    """(2, n) int, flags of intervals that are not known well enough; now and next."""
    skipped: Any
    """(e,) int"""
