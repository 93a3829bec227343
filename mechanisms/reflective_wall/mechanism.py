"""A ball between two walls is reflected by them as light is by a mirror, and bounces on the floor.
Walls and floor give back all of its speed, so it comes back to where it was thrown and draws one closed figure; the
variants lose a part at each impact, or have soft walls that the ball presses in.
"""

from dataclasses import dataclass
from math import pi, sqrt

from mbsd import Mechanism

DURATION = 2.4

VARIANTS = {
    "lossy": {"restitution": 0.85},
    "soft": {"stiffness": 2e6},
}


@dataclass(frozen=True)
class Params:
    """Sizes (m), mass (kg) of the ball, its start (m from the left wall), restitution, weight (m/s^2).

    ``rhythm``: so many bounces on the floor in so many journeys from wall to wall and back, until the figure closes.
    With a ``stiffness`` (N/m^1.5, Hertz) walls and floor yield instead; 0 is rigid.
    """

    width: float = 0.300
    height: float = 0.1962  # of its fall, which lasts 0.2 s
    radius: float = 0.020
    mass: float = 0.09
    start: float = 0.060
    rhythm: tuple[int, int] = (3, 2)
    restitution: float = 1.0
    stiffness: float = 0.0
    gravity: float = 9.81


def speed(p: Params) -> float:
    """Speed of the throw (m/s), at which the figure closes."""
    bounces, journeys = p.rhythm
    fall = sqrt(2 * p.height / p.gravity)
    return (p.width - 2 * p.radius) * journeys / (bounces * fall)


def build(p: Params) -> Mechanism:
    """The floor is the x axis and the left wall the y axis; the ball is thrown level, to the right."""
    m = Mechanism("reflective_wall", gravity=(0.0, -p.gravity))
    ball = m.body("ball", mass=p.mass, inertia=0.4 * p.mass * p.radius**2)
    walls = {"floor": (0.0, 0.0), "left": (0.0, -pi / 2), "right": (p.width, pi / 2)}
    for name, (x, angle) in walls.items():
        wall = m.ground.at(x, 0, angle)
        if p.stiffness:
            m.contact(name, wall, ball.origin, p.stiffness, radius=p.radius)
        else:
            m.rigid_contact(name, wall, ball.origin, p.radius, p.restitution)
    m.trace("P", ball.origin)
    m.start_near(ball=(p.start, p.radius + p.height, 0))
    m.start_moving(ball=(speed(p), 0, 0))
    return m
