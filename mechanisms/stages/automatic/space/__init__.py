"""Automatic parts in space: round rods between joints, ends that fit their joints, and posts on a base.

In this order, a chapter each:

    moves.py      poses of all bodies over the motion; one size from the lengths of the links
    round.py      round solids along any axis: rods, eyes, yokes, cups, blocks
    ends.py       what each joint asks of its two bodies, and of its own massless link
    bodies.py     a body: its ends joined by straight rods, discs and balls
    base.py       posts from the joints of ground to the base, where nothing passes
    machine.py    the face: all solids by body; or the joint for which there is no shape

No search for layers: a joint has a place and an axis, and its parts stand along that axis.
"""
