"""Gradients in ten numbers beside the motions that they are of.

A door that bounces to rest on a stop, eleven impacts in 0.9 s, by its hinge, spring, stop, masses and start: the
integral of its angle. A four-bar that a spring and gravity drive for 1 s, without an event: the angle at its end. A
sweep of a slider-crank: the largest effort of its motor. Errors are those against central differences of fourth order
of whole motions.
"""

from __future__ import annotations

DOOR = "gradient in 10 numbers, door with 11 impacts"
LINKAGE = "gradient in 10 numbers, four-bar simulated for 1 s"
SWEEP = "gradient in 10 numbers, sweep of a slider-crank"
MOST = 4.0
"""Simulations that a gradient of the door takes at most."""
