"""Automatic parts in space: round rods between joints, ends that fit them, posts on a base.

In this order, a chapter each:

    moves.py      poses of all bodies over the motion; one size from the lengths of the links
    round.py      round solids along any axis: rods, eyes, yokes, cups, blocks
    pieces.py     what chapters exchange: ends, stands, links; one block for bores side by side
    surroundings.py    where else a body is held, and how it lies to the axis of a joint
    wheels.py     discs with rims, on axles and in forks
    gears.py      bevel wheels with teeth
    slides.py     cylinders with rods, balls on plates
    ends.py       what each joint asks of its two bodies, and of its own massless link
    bodies.py     a body: its ends joined by straight rods, discs and balls
    base.py       posts from the joints of ground to the base, where nothing passes
    machine.py    the face: all solids by body; or the joint for which there is no shape

No search for layers: a joint has a place and an axis, and its parts stand along that axis.
"""
