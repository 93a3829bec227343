"""A four-bar's motion in closed form, as data.json holds it; owes nothing to the solver.

Positions from the triangle B-C-D, velocities and accelerations from the differentiated loop, reactions and motor
torque from the nine Newton-Euler equations of the three bars.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from shared.contract import (
    Action,
    BodyMotion,
    Diagnostics,
    DriverMotion,
    Energy,
    EventMark,
    JointMotion,
    Motion,
    PointMotion,
    Provenance,
)
from shared.contract.skeleton import Carried, CarriedName, Carrier, End, Moving, Name, Pose, Skeleton, Stroke

GRAVITY = np.array([0.0, -9.81])
MASSES = {"crank": 0.05, "coupler": 0.12, "rocker": 0.10}
HEIGHTS = {"crank": 0.010, "coupler": 0.016, "rocker": 0.010}


def four_bar_motion(
    steps: int = 360,
    turns: int = 1,
    ground: float = 0.120,
    crank: float = 0.040,
    coupler: float = 0.120,
    rocker: float = 0.090,
    speed: float = 2 * np.pi,
    point: tuple[float, float] = (0.06, 0.03),
) -> Motion:
    """A crank-rocker A-B-C-D turning at ``speed`` (rad/s); ``steps`` intervals a turn, both ends of the time given."""
    period = 2 * np.pi / speed
    time = np.linspace(0.0, turns * period, turns * steps + 1)
    lengths = {"crank": crank, "coupler": coupler, "rocker": rocker}
    zero = np.zeros_like(time)

    theta = {"crank": speed * time}
    a, d = np.zeros((time.size, 2)), np.broadcast_to([ground, 0.0], (time.size, 2))
    b = crank * _unit(theta["crank"])
    diagonal = d - b
    length = np.hypot(*diagonal.T)
    bend = np.arccos((coupler**2 + length**2 - rocker**2) / (2 * coupler * length))
    theta["coupler"] = np.unwrap(np.arctan2(diagonal[:, 1], diagonal[:, 0]) + bend)
    c = b + coupler * _unit(theta["coupler"])
    theta["rocker"] = np.unwrap(np.arctan2(*(c - d).T[::-1]))

    # Loop: crank n2 w2 + coupler n3 w3 - rocker n4 w4 = 0 and its derivative, n the normals of the bars.
    u = {name: _unit(angle) for name, angle in theta.items()}
    n = {name: _normal(value) for name, value in u.items()}
    loop = np.stack([coupler * n["coupler"], -rocker * n["rocker"]], axis=-1)
    rate = np.linalg.solve(loop, -crank * speed * n["crank"][..., None])[..., 0]
    omega = {"crank": zero + speed, "coupler": rate[:, 0], "rocker": rate[:, 1]}
    centripetal = sum(
        sign * lengths[name] * omega[name][:, None] ** 2 * u[name]
        for name, sign in (("crank", 1), ("coupler", 1), ("rocker", -1))
    )
    bent = np.linalg.solve(loop, np.asarray(centripetal)[..., None])[..., 0]
    alpha = {"crank": zero, "coupler": bent[:, 0], "rocker": bent[:, 1]}

    origin = {"crank": a, "coupler": b, "rocker": d}
    still = np.zeros_like(a)
    origin_v = {"crank": still, "coupler": crank * speed * n["crank"], "rocker": still}
    origin_a = {"crank": still, "coupler": -crank * speed**2 * u["crank"], "rocker": still}

    def at(body: str, x: float, y: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position, velocity and acceleration of a point of a body."""
        arm = x * u[body] + y * n[body]
        w, e = omega[body][:, None], alpha[body][:, None]
        return (
            origin[body] + arm,
            origin_v[body] + w * _normal(arm),
            origin_a[body] + e * _normal(arm) - w**2 * arm,
        )

    centre = {name: at(name, lengths[name] / 2, 0.0) for name in lengths}
    inertia = {name: MASSES[name] * lengths[name] ** 2 / 12 for name in lengths}
    pins = {"A": a, "B": b, "C": c, "D": d}
    on_body = {"crank": {"A": 1, "B": -1}, "coupler": {"B": 1, "C": -1}, "rocker": {"C": 1, "D": 1}}
    matrix, right = np.zeros((time.size, 9, 9)), np.zeros((time.size, 9))
    for row, (body, joints) in enumerate(on_body.items()):
        position, _, acceleration = centre[body]
        for joint, sign in joints.items():
            column, arm = 2 * "ABCD".index(joint), pins[joint] - position
            matrix[:, 3 * row, column] = matrix[:, 3 * row + 1, column + 1] = sign
            matrix[:, 3 * row + 2, column] = -sign * arm[:, 1]
            matrix[:, 3 * row + 2, column + 1] = sign * arm[:, 0]
        right[:, 3 * row : 3 * row + 2] = MASSES[body] * (acceleration - GRAVITY)
        right[:, 3 * row + 2] = inertia[body] * alpha[body]
    matrix[:, 2, 8] = 1.0
    solved = np.linalg.solve(matrix, right[..., None])[..., 0]
    torque = solved[:, 8]

    kinetic = sum(0.5 * MASSES[k] * (centre[k][1] ** 2).sum(1) + 0.5 * inertia[k] * omega[k] ** 2 for k in lengths)
    potential = sum(-MASSES[k] * centre[k][0] @ GRAVITY for k in lengths)
    power = sum(
        MASSES[k] * (centre[k][1] * (centre[k][2] - GRAVITY)).sum(1) + inertia[k] * omega[k] * alpha[k] for k in lengths
    )
    p, v, acc = at("coupler", *point)
    ends = {"A": ("ground", "crank"), "B": ("crank", "coupler"), "C": ("coupler", "rocker"), "D": ("ground", "rocker")}
    return Motion(
        mechanism="four_bar",
        provenance=Provenance(inputs="0" * 64, versions={"mbsd": "0.1.0"}),
        gravity=(float(GRAVITY[0]), float(GRAVITY[1])),
        period=float(period),
        time=time.tolist(),
        bodies={
            k: BodyMotion(
                **_columns(origin[k], origin_v[k], origin_a[k]),
                theta=theta[k].tolist(),
                omega=omega[k].tolist(),
                alpha=alpha[k].tolist(),
                z=HEIGHTS[k],
                mass=MASSES[k],
                com=(lengths[k] / 2, 0.0),
                inertia=inertia[k],
            )
            for k in lengths
        },
        joints={
            k: JointMotion(
                kind="revolute",
                pair="pin",
                bodies=ends[k],
                x=pins[k][:, 0].tolist(),
                y=pins[k][:, 1].tolist(),
                fx=solved[:, 2 * i].tolist(),
                fy=solved[:, 2 * i + 1].tolist(),
                torque=zero.tolist(),
            )
            for i, k in enumerate("ABCD")
        },
        drivers={
            "motor": DriverMotion(
                kind="angle",
                actions=[
                    Action(
                        body=body,
                        **dict.fromkeys(("x", "y", "fx", "fy"), zero.tolist()),
                        torque=(sign * torque).tolist(),
                    )
                    for body, sign in (("ground", -1.0), ("crank", 1.0))
                ],
                value=theta["crank"].tolist(),
                effort=torque.tolist(),
                power=(torque * speed).tolist(),
            )
        },
        points={"P": PointMotion(body="coupler", **_columns(p, v, acc))},
        energy=Energy(kinetic=np.asarray(kinetic).tolist(), potential=np.asarray(potential).tolist()),
        diagnostics=Diagnostics(
            position_residual=float(np.abs(np.hypot(*(c - d).T) - rocker).max()),
            velocity_residual=float(np.abs(at("coupler", coupler, 0)[1] - at("rocker", rocker, 0)[1]).max()),
            acceleration_residual=float(np.abs(at("coupler", coupler, 0)[2] - at("rocker", rocker, 0)[2]).max()),
            power_residual=float(np.abs(power - torque * speed).max()),
            dof=1,
            redundant=[],
            # The sine of the transmission angle: zero where the real margin is.
            singularity_margin=np.abs(np.sin(theta["rocker"] - theta["coupler"])).tolist(),
        ),
    )


def bouncing_ball(steps: int = 40, restitution: float = 0.5, mass: float = 0.2) -> Motion:
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
    return Motion(
        mechanism="ball",
        provenance=Provenance(inputs="0" * 64, versions={}),
        gravity=(0.0, -g),
        period=None,
        time=times.tolist(),
        bodies={"ball": BodyMotion(**columns, **turning, z=0.0, mass=mass, com=(0.0, 0.0), inertia=1e-4)},
        joints={},
        drivers={},
        points={"P": PointMotion(body="ball", **columns)},
        energy=Energy(kinetic=(mass * vy**2 / 2).tolist(), potential=(mass * g * y).tolist()),
        events=[EventMark(time=strike, name="floor", what="impact", energy=loss)],
        diagnostics=Diagnostics(
            position_residual=0.0, velocity_residual=0.0, acceleration_residual=0.0, power_residual=0.0, dof=3,
            redundant=[], singularity_margin=np.ones_like(times).tolist(),
        ),
    )  # fmt: skip


def plain_skeleton(motion: Motion, poses: int = 12) -> Skeleton:
    """Bars between the joints of each body, and a name at each body and joint: what the plots need of a skeleton."""
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


def _moving(motion: Motion, bars: list[Stroke], names: list[Name]) -> Moving:
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
