"""Bounds of the search for events and of impacts, for single simulations and for the compiled loop over many."""

from __future__ import annotations

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
HAIR = 1e-9
"""Part of their limits that joints at rest lack when one of them has just come to its limit."""
ROUNDING, PATIENCE = 1e-9, 20
"""Part of the largest normal force of a joint that may be left after so many passes."""
PASSES = 100
"""Passes in which joints at rest agree on how they share their friction, at most."""
AGREED = 1e-12
"""Part of the largest friction that may still change."""
