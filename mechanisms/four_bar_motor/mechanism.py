"""A four-bar that an electric motor starts from rest and brings to full speed within two turns.
Then its speed still rises and falls with every turn, because links and weights take and give energy, and the motor
follows its torque-speed curve: it pulls the more the slower it turns.
"""

from dataclasses import dataclass

from mbsd import Curve, Mechanism, curve

DURATION = 3.0
STEPS = 1080
SPECTRA = ("crank", "motor", "shaking force")


@dataclass(frozen=True)
class Params:
    """Lengths (m), masses of uniform links (kg), motor and pinion, a load on the rocker (N m s/rad)."""

    ground: float = 0.120
    crank: float = 0.040
    coupler: float = 0.120
    rocker: float = 0.090
    teeth: tuple[int, int] = (20, 60)  # of the motor's pinion and of the wheel on the crank
    module: float = 0.002
    wheel: tuple[float, float] = (0.8, 2.5e-3)  # mass (kg) and inertia (kg m^2) of the wheel, with the crank
    rotor: tuple[float, float] = (0.3, 1.0e-4)
    speeds: tuple[float, ...] = (0.0, 25.0, 45.0, 54.0, 60.0)  # of the motor (rad/s)
    torques: tuple[float, ...] = (0.032, 0.036, 0.042, 0.032, 0.0)  # at these speeds (N m)
    coupler_mass: float = 0.15
    rocker_mass: float = 0.12
    load: float = 0.005
    gravity: float = 9.81

    @property
    def torque_speed(self) -> Curve:
        """Curve of the motor.

        It turns clockwise for the crank to turn the other way: speed and torque are negative.
        """
        return curve([-speed for speed in self.speeds[::-1]], [-torque for torque in self.torques[::-1]])


def build(p: Params) -> Mechanism:
    """A-B-C-D as in four_bar; the pinion is to the left of the wheel about A."""
    m = Mechanism("four_bar_motor", gravity=(0.0, -p.gravity))
    crank = m.bar("crank", p.crank, mass=p.wheel[0], com=(0, 0), inertia=p.wheel[1])
    coupler, rocker = m.bar("coupler", p.coupler, p.coupler_mass), m.bar("rocker", p.rocker, p.rocker_mass)
    rotor = m.body("rotor", mass=p.rotor[0], inertia=p.rotor[1])
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(p.ground, 0), rocker.start)
    m.revolute("M", m.ground.at(-p.module * sum(p.teeth) / 2, 0), rotor.origin)
    m.gear_pair("gears", rotor.origin, crank.start, teeth=p.teeth, module=p.module)
    m.motor("motor", m.ground, rotor, p.torque_speed)
    m.torsion_spring("load", m.ground, rocker, stiffness=0.0, damping=p.load)
    m.start_near(crank=-90, coupler=45, rocker=100)
    return m
