"""Bounds of the search for events and of impacts."""

from __future__ import annotations

import numpy as np

HALVINGS = 40
"""How close to a bounce its return is looked for: this many halvings of a part of a step."""
ROUNDS = 200
"""Rounds of an impact; after so many, all closed contacts are solved at once without rebound."""
CREEP = 1e-6
"""Part of the rates that count as zero, beyond which a contact that carries nothing still closes."""
DEPENDENT = 1e-9
"""Part of its compliance that the rows before must leave of a row."""
AT_LIMIT = 1e-10
"""Part of the limit of friction: closer to it a contact slides."""
AT_LIMIT_BEYOND = 1e-12
"""The same of joints where one has come to its limit: contacts may leave it little of the motion that it had alone."""
UNSURE = 1e-13
"""Part of the acceleration of a way without normal forces and friction that is rounding of what these leave of it."""
GRAZING = 1e-7
"""Part of what acts on a gap below which its acceleration is none, where a contact closes that does not push yet."""
BEGINS = 1e-300
"""Normal force of a contact that holds though it does not push yet (N)."""
HAIR = 1e-9
"""Part of their limits that joints at rest lack when one of them has just come to its limit."""
ROUNDING, PATIENCE = 1e-9, 20
"""Part of the largest normal force of a joint that may be left after so many passes."""
PASSES = 100
"""Passes in which joints at rest agree on how they share their friction, at most."""
AGREED = 1e-12
"""Part of the largest friction that may still change."""
PASSES_TOGETHER, AGREED_TOGETHER = 30, 1e-11
"""Passes in which contacts and joints that hold together agree on their limits, at most; what may still change."""
PASSES_BETWEEN = 100
"""The same where they are looked for between bounds."""
MOST_PUSH = 10.0
"""Times all normal forces before, and what loads ask for, that they may be after they are divided: where bodies wedge
the least part of their limits belongs to infinite ones."""
WEAKEST = 1e-9
"""Part of the largest limit that each has at least, where limits are weights."""
TRIED = np.array([0.1337, 0.5437])
"""Parts of a step at which the polynomial through a function of the user is tried; no simple fractions, which a period
might share."""
ROUGH, ROUGH_HALVES = 0.01, 0.05
"""Fractions of what the function changes by in a step: what is missed by more is not known; at first, and in halves."""
PER_SHORTEST = 2.0
"""Looks at the shortest thing in a function."""
FAR = 10.0
"""Times what a function changes by in a step: from there it does not come to zero, and changes may be rounding."""
NARROWEST = 1.0 / 2048
MOST_VALUES = 512
"""Values in one step."""
NEAR = 1e-11
"""Gaps below this part of the size (rad) are closed; rates below it by 1 s are zero where bodies rest."""
ROUNDINGS = ((1.0, 1.0, -1.0, -1.0), (-1.0, 1.0, 1.0, -1.0), (1.0, -1.0, 1.0), (-1.0, -1.0, 1.0, 1.0, 1.0))
"""Signs, repeated, of small changes of a state."""
AHEAD = (1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)
"""Parts of the duration after which the side is looked for to which an event that is zero goes."""
BEYOND = (1e-6, 1e-5, 1e-4, 1e-3)
"""Times (s) after which it is looked for where a duration is too short to tell."""
LESS = 1e-3
"""Part of NEAR by which a state is changed to tell a jump from a slope."""
IN_TURN = 5
"""Events at one time, for each contact, after which contacts are no longer taken one by one."""
STILL = 1e-9
"""Rates below this part of the size (rad) by 1 s are zero."""
