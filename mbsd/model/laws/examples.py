"""Examples of every law, at least one each; the test of all laws needs them."""

from __future__ import annotations

import math

import numpy as np

from mbsd.model.laws import Motion, constant_rate, cycloidal, function, harmonic, polynomial, recorded, table

EXAMPLES: tuple[Motion, ...] = (
    constant_rate(1.3, 0.2),
    harmonic(0.4, 3.1, 0.3, 0.1),
    polynomial(0.3, -0.2, 0.7, 0.05),
    cycloidal(0.8, 1.1, 0.2, -0.1),
    table(np.linspace(-0.5, 2.5, 40), np.cos(np.linspace(-0.5, 2.5, 40))),
    table(np.linspace(0.0, 1.5, 41), np.sin(np.linspace(0.0, 2 * math.pi, 41)), periodic=True),
    recorded(np.linspace(-0.5, 2.5, 60), np.cos(np.linspace(-0.5, 2.5, 60)), noise=0.0),
    function(math.sin, math.cos, lambda t: -math.sin(t)),
    function(lambda t: math.exp(-t) * math.sin(3 * t)),
)
