"""A scissor lift of two crosses: one foot slides on the floor, and the platform rises level.
Each cross multiplies the lift: near the bottom a little travel of the foot gives much height, near the top hardly any.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """Length of the bars (m), crosses, where the foot is: mean, amplitude (m), and its rate (rad/s)."""

    bar: float = 0.160
    crosses: int = 2
    mean: float = 0.110
    amplitude: float = 0.035
    rate: float = pi / 2


def build(p: Params) -> Mechanism:
    """Bars a rise to the right, bars b to the left; y is up."""
    m = Mechanism("scissor_lift")
    foot, platform, shoe = m.body("foot"), m.body("platform"), m.body("shoe")
    left, right = m.ground.at(0, 0), foot.origin
    for k in range(1, p.crosses + 1):
        a, b = m.bar(f"a{k}", p.bar), m.bar(f"b{k}", p.bar)
        m.revolute(f"left{k}", left, a.start)
        m.revolute(f"right{k}", right, b.start)
        m.revolute(f"middle{k}", a.at(p.bar / 2, 0), b.at(p.bar / 2, 0))
        left, right = b.end, a.end
        m.start_near(**{a.name: 45, b.name: 135})
    m.revolute("hinge", left, platform.origin)
    m.revolute("shoe_pin", right, shoe.origin)
    m.prismatic("floor", m.ground.at(0, 0), foot.origin)
    m.prismatic("rail", platform.origin, shoe.origin)
    m.drive_coordinate("cylinder", m.ground.at(0, 0), foot.origin, harmonic(p.amplitude, p.rate, pi / 2, p.mean))
    m.start_near(platform=0, shoe=0, foot=0)
    return m
