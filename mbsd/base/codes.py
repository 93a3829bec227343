"""Codes that the model writes into tables and kernels read; equations stand with their kernels."""

from __future__ import annotations

LINE, TURN, AXIS, PUSH = 0, 1, 2, 3
"""Codes of what an element of a force measures and acts along: see mbsd/model/force.py."""
CONSTANT, LINEAR, DAMPING, POWER, LAW_VALUE, LAW_RATE, LAW_TIME, DRY = 0, 1, 2, 3, 4, 5, 6, 7
"""Terms of an element's magnitude."""
POTENTIAL_TERMS = (LINEAR, POWER, LAW_VALUE)
"""Terms that count as potential energy; the others do work."""

POLYNOMIAL, HARMONIC, CYCLOIDAL, PIECES = 0, 1, 2, 3
"""Forms of laws: see mbsd/equations/laws.py."""
TANGENT, PERIODIC = 0.0, 1.0
"""Codes of how pieces go on beyond their breaks."""

STIFFNESS, DAMPER, FREE = 0, 1, 2
"""Codes of the number of a spring that is a law of time: see mbsd/equations/interactions/spring_in_time.py."""

FRICTION_JOINTS = ("revolute", "prismatic", "pin_in_slot")
"""Joints that can have friction, in the order of their shapes: see mbsd/equations/joint_friction.py."""
MOST_STATES = 2
"""Largest number of states that a force may carry."""
