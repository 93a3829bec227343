"""The slider-crank of the tests of friction."""

from __future__ import annotations

from collections.abc import Sequence

from mbsd import STANDARD_GRAVITY, Mechanism


def slider_crank(gravity: Sequence[float] | None = STANDARD_GRAVITY) -> Mechanism:
    """Crank 0.1 m at 30 degrees, rod 0.3 m; pins O, A, B and the guide ``rail``."""
    m = Mechanism("slider-crank", gravity=gravity)
    crank, rod, slider = m.bar("crank", 0.1, 1.0), m.bar("rod", 0.3, 0.8), m.body("slider", 1.5, inertia=0.01)
    m.revolute("O", m.ground.origin, crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("rail", m.ground.origin, slider.origin)
    m.start_near(crank=30, rod=-10, slider=(0.37, 0, 0))
    return m
