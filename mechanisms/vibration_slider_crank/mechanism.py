"""A piston shakes its machine: what the moving masses push on the frame, once a turn and twice a turn.
A counterweight takes away half of the first harmonic and turns the rest across the guide; a balancer that turns
backwards takes that too, and only the second harmonic, which comes from the rod's leaning, is left.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate

VARIANTS = {
    "counterweight": {"counterweight": True},
    "balanced": {"counterweight": True, "balancer": True},
}
SPECTRA = ("shaking force", "shaking moment", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), masses (kg), speed (rad/s: 1500 turns a minute)."""

    crank: float = 0.040
    rod: float = 0.140
    arm: float = 0.042  # of the balancing weights
    crank_mass: float = 0.4  # its centre is halfway to the crank pin
    rod_mass: float = 0.3  # its centre is at a third of its length from the crank pin
    piston_mass: float = 0.4
    wheel_mass: float = 0.4  # of the balancer without its weight
    teeth: int = 44
    module: float = 0.003
    speed: float = 50 * pi
    counterweight: bool = False
    balancer: bool = False

    @property
    def oscillating(self) -> float:
        """The piston, and the third of the rod that goes with it (kg)."""
        return self.piston_mass + self.rod_mass / 3

    @property
    def rotating(self) -> float:
        """Unbalance of the crank, with the two thirds of the rod that go with its pin (kg m)."""
        return (self.crank_mass / 2 + 2 * self.rod_mass / 3) * self.crank

    @property
    def counter_mass(self) -> float:
        """Balances all that rotates and half of what oscillates (kg)."""
        return (self.rotating + self.oscillating * self.crank / 2) / self.arm if self.counterweight else 0.0

    @property
    def balancer_mass(self) -> float:
        """The weight on the balancer for the other half (kg)."""
        return self.oscillating * self.crank / 2 / self.arm


def build(p: Params) -> Mechanism:
    """Without weight, which does not shake.

    The rod is as two masses on its pins: inertia mass * l/3 * 2l/3.
    """
    m = Mechanism("vibration_slider_crank", gravity=None)
    tail = p.arm if p.counterweight else 0.0
    mass = p.crank_mass + p.counter_mass
    centre = (p.crank_mass * p.crank / 2 - p.counter_mass * p.arm) / mass
    inertia = p.crank_mass * p.crank**2 / 3 + p.counter_mass * p.arm**2 - mass * centre**2
    crank = m.bar("crank", tail + p.crank, mass=mass, com=(tail + centre, 0), inertia=inertia)
    rod = m.bar("rod", p.rod, p.rod_mass, com=(p.rod / 3, 0), inertia=2 * p.rod_mass * p.rod**2 / 9)
    piston = m.body("piston", mass=p.piston_mass)
    m.revolute("O", m.ground.at(0, 0), crank.at(tail, 0))
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, piston.origin)
    m.prismatic("guide", m.ground.at(0, 0), piston.origin)
    m.drive_angle("motor", crank, constant_rate(p.speed))
    m.start_near(crank=0, rod=0, piston=0)
    if p.balancer:
        _balancer(m, p, tail)
    return m


def _balancer(m: Mechanism, p: Params, tail: float) -> None:
    """Add a shaft that an equal gear turns backwards; its weight starts opposite to the crank pin."""
    mass = p.wheel_mass + p.balancer_mass
    centre = p.balancer_mass * p.arm / mass
    radius = p.teeth * p.module / 2
    inertia = p.wheel_mass * radius**2 / 2 + p.balancer_mass * p.arm**2 - mass * centre**2
    balancer = m.bar("balancer", p.arm, mass=mass, com=(centre, 0), inertia=inertia)
    m.revolute("Q", m.ground.at(0, -2 * radius), balancer.start)
    crank = m.bodies["crank"]
    m.gear_pair("gears", crank.at(tail, 0), balancer.start, teeth=(p.teeth, p.teeth), module=p.module)
    m.start_near(balancer=180)
