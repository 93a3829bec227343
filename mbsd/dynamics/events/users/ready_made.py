"""The ready-made functions of events of model/event.py, as compiled functions at addresses."""

from __future__ import annotations

import math

from mbsd.compiling.callback import SIGNATURE
from mbsd.compiling.jit import at_address


@at_address(SIGNATURE)
def turned(t, inputs, outputs):
    """Angle of one frame."""
    outputs[0] = inputs[2]


@at_address(SIGNATURE)
def turning(t, inputs, outputs):
    """Angular velocity of one frame."""
    outputs[0] = inputs[5]


@at_address(SIGNATURE)
def distance(t, inputs, outputs):
    """Distance of two frames."""
    outputs[0] = math.hypot(inputs[3] - inputs[0], inputs[4] - inputs[1])
