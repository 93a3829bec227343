"""The barbell hip thrust: the back turns on the edge of a bench, and the hips push a barbell up.
What hip, knee and ankle must give follows from the motion: most of it comes from the hip, and most of that early. Squat
and deadlift with the same barbell (variants) take more of the knee, or of the hip alone.
"""

from dataclasses import dataclass
from math import degrees

from mbsd import Mechanism, Solution
from mbsd.machines.body.chain import Tempo
from mbsd.machines.body.figure import Figure
from mbsd.machines.body.hip_thrust import ELBOWS_BACK, hip_thrust
from mbsd.machines.body.lift import with_moments
from mbsd.machines.body.squat_and_deadlift import ELBOWS_DOWN, bar_on_shoulders, deadlift, squat

VARIANTS = {
    "squat": {"exercise": "squat", "up": 1.5},
    "deadlift": {"exercise": "deadlift", "up": 1.5},
    "feet_near": {"distance": 0.75},
    "low_bench": {"bench": 0.30, "nod": 15.0},
}


@dataclass(frozen=True)
class Params:
    """Height (m) and mass (kg) of the lifter, the barbell (kg), the bench (m), time of the lift (s)."""

    exercise: str = "hip_thrust"
    height: float = 1.78
    mass: float = 80.0
    load: float = 65.0
    bench: float = 0.40
    distance: float = 0.0  # from the pad to the ankle; 0: the shank is upright at the top
    flexion: float = 90.0  # of the hip at the bottom, degrees
    bar: tuple[float, float] = (0.10, 0.14)  # along the trunk from the hip, and in front of it
    grip: float = 0.15  # friction of the pad, of its normal force
    pressure: float = 0.03  # where the floor pushes, in front of the ankle
    nod: float = 0.0  # of the head of the mannequin, degrees: at the top it is below the shoulders on a low bench
    line: float = 0.10  # of the bar in front of the ankle, of a deadlift
    up: float = 1.0  # seconds; 1.5 of the variants, whose bar goes farther


def build(p: Params) -> Mechanism:
    """The lifter faces right; in the hip thrust the head is on the left."""
    who, tempo = figure(p), Tempo(up=p.up)
    if p.exercise == "squat":
        return squat(who, p.load, tempo=tempo, name="hip_thrust")
    if p.exercise == "deadlift":
        return deadlift(who, p.load, line=p.line, tempo=tempo, name="hip_thrust")
    return hip_thrust(
        who,
        p.load,
        flexion=(p.flexion, 0.0),
        bench=p.bench,
        distance=p.distance or None,
        bar=p.bar,
        pressure=p.pressure,
        grip=p.grip,
        tempo=tempo,
    )


def motion(m: Mechanism, p: Params) -> Solution:
    """The moments of the joints make the motion, not the guides that give it."""
    return with_moments(m, m.sweep())


def figure(p: Params) -> Figure:
    """Who lifts."""
    return Figure(p.height, p.mass)


def arm_angles(p: Params) -> tuple[float, float]:
    """Angles of upper arm and forearm against the trunk, or against a straight arm that hangs (degrees)."""
    who = figure(p)
    shoulder = (who.length("trunk"), 0.0)
    if p.exercise == "deadlift":
        return 0.0, 0.0
    if p.exercise == "squat":
        angles = who.arm_angles(shoulder, bar_on_shoulders(who), ELBOWS_DOWN)
    else:
        angles = who.arm_angles(shoulder, (p.bar[0], -p.bar[1]), ELBOWS_BACK)
    return degrees(angles[0]), degrees(angles[1])
