"""A four-bar's motion in closed form, as data.json holds it; owes nothing to the solver.

Positions from the triangle B-C-D, velocities and accelerations from the differentiated loop, reactions and motor
torque from the nine Newton-Euler equations of the three bars.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from shared import contract
from shared.contract.skeleton import Carried, CarriedName, Carrier, End, Moving, Name, Pose, Skeleton, Stroke

GRAVITY = np.array([0.0, -9.81])
MASSES = {"crank": 0.05, "coupler": 0.12, "rocker": 0.10}
HEIGHTS = {"crank": 0.010, "coupler": 0.016, "rocker": 0.010}


BARS = ("crank", "coupler", "rocker")
PINS = {"A": ("ground", "crank"), "B": ("crank", "coupler"), "C": ("coupler", "rocker"), "D": ("ground", "rocker")}
"""The bodies of each pin; the second feels its force, the first the opposite one."""
PUSHED = {"crank": {"A": 1, "B": -1}, "coupler": {"B": 1, "C": -1}, "rocker": {"C": 1, "D": 1}}
"""Sign of each pin's force on each bar."""


class FourBar:
    """A crank-rocker A-B-C-D at given times (T,), in closed form.

    It turns at ``speed`` (rad/s); angles are (T,), places (T, 2) (m).
    """

    def __init__(self, time: np.ndarray, ground: float, lengths: dict[str, float], speed: float) -> None:
        self.lengths, zero = lengths, np.zeros_like(time)
        crank, coupler, rocker = (lengths[name] for name in BARS)
        a, d = np.zeros((time.size, 2)), np.broadcast_to([ground, 0.0], (time.size, 2))
        self.theta = {"crank": speed * time}
        b = crank * _unit(self.theta["crank"])
        diagonal = d - b
        length = np.hypot(*diagonal.T)
        bend = np.arccos((coupler**2 + length**2 - rocker**2) / (2 * coupler * length))
        self.theta["coupler"] = np.unwrap(np.arctan2(diagonal[:, 1], diagonal[:, 0]) + bend)
        c = b + coupler * _unit(self.theta["coupler"])
        self.theta["rocker"] = np.unwrap(np.arctan2(*(c - d).T[::-1]))
        self.pins = {"A": a, "B": b, "C": c, "D": d}
        # Loop: crank n2 w2 + coupler n3 w3 - rocker n4 w4 = 0 and its derivative, n the normals of the bars.
        self.along = u = {name: _unit(angle) for name, angle in self.theta.items()}
        self.across = n = {name: _normal(value) for name, value in u.items()}
        loop = np.stack([coupler * n["coupler"], -rocker * n["rocker"]], axis=-1)
        rate = np.linalg.solve(loop, -crank * speed * n["crank"][..., None])[..., 0]
        self.omega = {"crank": zero + speed, "coupler": rate[:, 0], "rocker": rate[:, 1]}
        centripetal = sum(
            sign * lengths[name] * self.omega[name][:, None] ** 2 * u[name]
            for name, sign in (("crank", 1), ("coupler", 1), ("rocker", -1))
        )
        bent = np.linalg.solve(loop, np.asarray(centripetal)[..., None])[..., 0]
        self.alpha = {"crank": zero, "coupler": bent[:, 0], "rocker": bent[:, 1]}
        still = np.zeros_like(a)
        self.frames = {
            "crank": (a, still, still),
            "coupler": (b, crank * speed * n["crank"], -crank * speed**2 * u["crank"]),
            "rocker": (d, still, still),
        }
        self.inertia = {name: MASSES[name] * lengths[name] ** 2 / 12 for name in BARS}
        self.centres = {name: self.point(name, lengths[name] / 2, 0.0) for name in BARS}

    def point(self, body: str, x: float, y: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return position, velocity and acceleration of a point of a body."""
        arm = x * self.along[body] + y * self.across[body]
        w, e = self.omega[body][:, None], self.alpha[body][:, None]
        place, velocity, acceleration = self.frames[body]
        return place + arm, velocity + w * _normal(arm), acceleration + e * _normal(arm) - w**2 * arm

    def efforts(self) -> np.ndarray:
        """Return (T, 9) forces of the pins A to D (N) and the motor's torque (N m).

        They are those of the Newton-Euler equations.
        """
        count = len(self.pins["A"])
        matrix, right = np.zeros((count, 9, 9)), np.zeros((count, 9))
        for row, (body, joints) in enumerate(PUSHED.items()):
            position, _, acceleration = self.centres[body]
            for joint, sign in joints.items():
                column, arm = 2 * "ABCD".index(joint), self.pins[joint] - position
                matrix[:, 3 * row, column] = matrix[:, 3 * row + 1, column + 1] = sign
                matrix[:, 3 * row + 2, column] = -sign * arm[:, 1]
                matrix[:, 3 * row + 2, column + 1] = sign * arm[:, 0]
            right[:, 3 * row : 3 * row + 2] = MASSES[body] * (acceleration - GRAVITY)
            right[:, 3 * row + 2] = self.inertia[body] * self.alpha[body]
        matrix[:, 2, 8] = 1.0
        return np.linalg.solve(matrix, right[..., None])[..., 0]

    def energies(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return kinetic and potential energy (J) and the power that they take (W), (T,) each."""
        kinetic = sum(
            0.5 * MASSES[k] * (self.centres[k][1] ** 2).sum(1) + 0.5 * self.inertia[k] * self.omega[k] ** 2
            for k in BARS
        )
        potential = sum(-MASSES[k] * self.centres[k][0] @ GRAVITY for k in BARS)
        power = sum(
            MASSES[k] * (self.centres[k][1] * (self.centres[k][2] - GRAVITY)).sum(1)
            + self.inertia[k] * self.omega[k] * self.alpha[k]
            for k in BARS
        )
        return np.asarray(kinetic), np.asarray(potential), np.asarray(power)

    def residuals(self) -> tuple[float, float, float]:
        """Return what the pin C is open by, and the differences of its velocity and acceleration on both bars."""
        opening = np.abs(np.hypot(*(self.pins["C"] - self.pins["D"]).T) - self.lengths["rocker"]).max()
        ends = (self.point(name, self.lengths[name], 0) for name in ("coupler", "rocker"))
        _, velocity, acceleration = (float(np.abs(a - b).max()) for a, b in zip(*ends, strict=True))
        return float(opening), velocity, acceleration


def four_bar_motion(
    steps: int = 360,
    turns: int = 1,
    ground: float = 0.120,
    crank: float = 0.040,
    coupler: float = 0.120,
    rocker: float = 0.090,
    speed: float = 2 * np.pi,
    point: tuple[float, float] = (0.06, 0.03),
) -> contract.Motion:
    """Return the motion of a crank-rocker; ``steps`` intervals a turn, both ends of the time given."""
    period = 2 * np.pi / speed
    time = np.linspace(0.0, turns * period, turns * steps + 1)
    bars = FourBar(time, ground, {"crank": crank, "coupler": coupler, "rocker": rocker}, speed)
    solved, (kinetic, potential, power) = bars.efforts(), bars.energies()
    torque, zero = solved[:, 8], np.zeros_like(time)
    pushes = dict.fromkeys(("x", "y", "fx", "fy"), zero.tolist())
    opening, velocity, acceleration = bars.residuals()
    return contract.Motion(
        mechanism="four_bar",
        provenance=contract.Provenance(inputs="0" * 64, versions={"mbsd": "0.1.0"}),
        gravity=(float(GRAVITY[0]), float(GRAVITY[1])),
        period=float(period),
        time=time.tolist(),
        bodies={name: _bar_motion(bars, name) for name in BARS},
        joints={
            name: contract.JointMotion(
                kind="revolute", pair="pin", bodies=bodies,
                x=bars.pins[name][:, 0].tolist(), y=bars.pins[name][:, 1].tolist(),
                fx=solved[:, 2 * i].tolist(), fy=solved[:, 2 * i + 1].tolist(), torque=zero.tolist(),
            )
            for i, (name, bodies) in enumerate(PINS.items())
        },
        drivers={
            "motor": contract.DriverMotion(
                kind="angle",
                actions=[
                    contract.Action(body=body, **pushes, torque=(sign * torque).tolist())
                    for body, sign in (("ground", -1.0), ("crank", 1.0))
                ],
                value=bars.theta["crank"].tolist(), effort=torque.tolist(), power=(torque * speed).tolist(),
            )
        },
        points={"P": contract.PointMotion(body="coupler", **_columns(*bars.point("coupler", *point)))},
        energy=contract.Energy(kinetic=kinetic.tolist(), potential=potential.tolist()),
        diagnostics=contract.Diagnostics(
            position_residual=opening, velocity_residual=velocity, acceleration_residual=acceleration,
            power_residual=float(np.abs(power - torque * speed).max()), dof=1, redundant=[],
            # The sine of the transmission angle: zero where the real margin is.
            singularity_margin=np.abs(np.sin(bars.theta["rocker"] - bars.theta["coupler"])).tolist(),
        ),
    )  # fmt: skip


def _bar_motion(bars: FourBar, name: str) -> contract.BodyMotion:
    return contract.BodyMotion(
        **_columns(*bars.frames[name]),
        theta=bars.theta[name].tolist(), omega=bars.omega[name].tolist(), alpha=bars.alpha[name].tolist(),
        z=HEIGHTS[name], mass=MASSES[name], com=(bars.lengths[name] / 2, 0.0), inertia=bars.inertia[name],
    )  # fmt: skip


def bouncing_ball(steps: int = 40, restitution: float = 0.5, mass: float = 0.2) -> contract.Motion:
    """A ball that falls 1 m and bounces once; both rows of the impact are there.

    It strikes at sqrt(2 / g) s with sqrt(2 g) m/s, where it loses (1 - e^2) m g of its energy.
    """
    g = float(-GRAVITY[1])
    strike = float(np.sqrt(2 / g))
    times = np.sort(np.append(np.linspace(0.0, 2 * strike, steps + 2 + steps % 2), [strike, strike]))
    after = times > strike
    after[np.flatnonzero(times == strike)[-1]] = True
    late = times - strike
    speed = restitution * g * strike
    zero = np.zeros_like(times)
    y = np.where(after, speed * late - g * late**2 / 2, 1.0 - g * times**2 / 2)
    vy = np.where(after, speed - g * late, -g * times)
    columns = _columns(np.stack([zero, y], 1), np.stack([zero, vy], 1), np.stack([zero, zero - g], 1))
    turning = {name: zero.tolist() for name in ("theta", "omega", "alpha")}
    loss = (restitution**2 - 1) * mass * g
    return contract.Motion(
        mechanism="ball",
        provenance=contract.Provenance(inputs="0" * 64, versions={}),
        gravity=(0.0, -g),
        period=None,
        time=times.tolist(),
        bodies={"ball": contract.BodyMotion(**columns, **turning, z=0.0, mass=mass, com=(0.0, 0.0), inertia=1e-4)},
        joints={},
        drivers={},
        points={"P": contract.PointMotion(body="ball", **columns)},
        energy=contract.Energy(kinetic=(mass * vy**2 / 2).tolist(), potential=(mass * g * y).tolist()),
        events=[contract.EventMark(time=strike, name="floor", what="impact", energy=loss)],
        diagnostics=contract.Diagnostics(
            position_residual=0.0, velocity_residual=0.0, acceleration_residual=0.0, power_residual=0.0, dof=3,
            redundant=[], singularity_margin=np.ones_like(times).tolist(),
        ),
    )  # fmt: skip


def plain_skeleton(motion: contract.Motion, poses: int = 12) -> Skeleton:
    """Return bars between the joints of each body, and names, as plots need them of a skeleton."""
    steps = np.linspace(0, len(motion.time) - 1, poses + 1).round().astype(int)[:-1]

    def bars(step: int) -> list[Stroke]:
        ends = {
            body: [
                value
                for joint in motion.joints.values()
                if body in joint.bodies
                for value in (joint.x[step], joint.y[step])
            ]
            for body in motion.bodies
        }
        return [
            Stroke(
                points=points, closed=len(points) > 4, ink=f"body:{body}", fill=f"body:{body}", alpha=0.2, width=1.5,
                order=2.0, dash=[],
            )
            for body, points in ends.items()
            if len(points) > 2
        ]  # fmt: skip

    names = [
        Name(text=name, at=(body.x[0], body.y[0]), clearance=0.003, ink=f"body:{name}")
        for name, body in motion.bodies.items()
    ]
    places: dict[tuple[float, float], list[str]] = {}
    for name, joint in motion.joints.items():
        places.setdefault((joint.x[0], joint.y[0]), []).append(name)
    names += [Name(text=", ".join(here), at=at, clearance=0.003, ink="ink") for at, here in places.items()]
    names += [
        Name(text=name, at=(point.x[0], point.y[0]), clearance=0.003, ink="ink")
        for name, point in motion.points.items()
    ]
    return Skeleton(
        mechanism=motion.mechanism, provenance=motion.provenance, unit=0.004, names=names,
        poses=[Pose(time=motion.time[step], strokes=bars(step)) for step in steps],
        moving=_moving(motion, bars(0), names),
    )  # fmt: skip


def _moving(motion: contract.Motion, bars: list[Stroke], names: list[Name]) -> Moving:
    """The bars, each carried by its body, and names that stay."""
    things = [*motion.bodies.values(), *motion.joints.values(), *motion.points.values()]
    places = np.array([(thing.x, thing.y) for thing in things])
    low, high = places.min(axis=(0, 2)), places.max(axis=(0, 2))
    ground = Carrier(kind="ground")
    return Moving(
        unit=0.004,
        low=(float(low[0]), float(low[1])),
        high=(float(high[0]), float(high[1])),
        strokes=[
            Carried(stroke=bar, carrier=Carrier(kind="body", ends=[End(body=bar.ink.removeprefix("body:"))]))
            for bar in bars
        ],
        names=[CarriedName(name=name, carrier=ground) for name in names],
        times=[motion.time[0], motion.time[-1]],
    )


def _unit(angle: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _normal(vector: np.ndarray) -> np.ndarray:
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)


def _columns(position: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray) -> dict[str, Any]:
    names = ("x", "y", "vx", "vy", "ax", "ay")
    return {
        name: column.tolist()
        for name, column in zip(names, np.hstack([position, velocity, acceleration]).T, strict=True)
    }
