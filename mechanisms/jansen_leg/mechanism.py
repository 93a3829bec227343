"""One leg of Theo Jansen's beach animals, with his eleven holy numbers: crank, triangles and bars.
The foot goes back along a nearly flat line, as on sand, then lifts and swings forward in an arc: rotation walks.
"""

from dataclasses import dataclass
from math import acos, cos, pi, sin

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Lengths by Jansen's letters (m; he gives no unit), the crank's speed (rad/s)."""

    a: float = 0.0380  # the crank's axis stands so far right of the fixed pivot
    b: float = 0.0415
    c: float = 0.0393
    d: float = 0.0401
    e: float = 0.0558
    f: float = 0.0394
    g: float = 0.0367
    h: float = 0.0657
    i: float = 0.0490
    j: float = 0.0500
    k: float = 0.0619
    l: float = 0.0078  # noqa: E741 and so far above it
    m: float = 0.0150  # crank
    speed: float = -pi / 2


def build(p: Params) -> Mechanism:
    """The fixed pivot is the origin. The upper triangle has the sides b, d, e, the lower one g, h, i."""
    m = Mechanism("jansen_leg")
    crank, upper, lower = m.bar("crank", p.m), m.body("upper"), m.body("lower")
    bars = {name: m.bar(f"bar_{name}", getattr(p, name)) for name in "jkcf"}
    at_pivot = acos((p.b**2 + p.d**2 - p.e**2) / (2 * p.b * p.d))
    at_knee = acos((p.g**2 + p.i**2 - p.h**2) / (2 * p.g * p.i))
    m.revolute("shaft", m.ground.at(p.a, p.l), crank.start)
    m.revolute("pivot", m.ground.at(0, 0), upper.origin)
    m.revolute("pivot_c", m.ground.at(0, 0), bars["c"].start)
    m.revolute("pin_j", crank.end, bars["j"].start)
    m.revolute("pin_k", crank.end, bars["k"].start)
    m.revolute("top", bars["j"].end, upper.at(p.b, 0))
    m.revolute("back", upper.at(p.d * cos(at_pivot), p.d * sin(at_pivot)), bars["f"].start)
    m.revolute("knee_k", bars["k"].end, lower.origin)
    m.revolute("knee_c", bars["c"].end, lower.origin)
    m.revolute("heel", bars["f"].end, lower.at(p.g, 0))
    m.drive_angle("motor", crank, constant_rate(p.speed))
    m.trace("foot", lower.at(p.i * cos(at_knee), p.i * sin(at_knee)))
    m.start_near(upper=90, lower=180, bar_j=150, bar_k=230, bar_c=-80, bar_f=-90)
    return m
