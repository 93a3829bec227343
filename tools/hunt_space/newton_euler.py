"""Newton and Euler by numpy and scipy, apart from the solver: residuals of joints, their derivatives by differences.

    m r'' = m g + f + sum of pushes,   I w' + w x I w = t + sum of moments,   J a = -dJ/dt v

A joint is what its name says of points and directions of the world in the design pose, carried along by both bodies. J
comes from central differences of order 6 of these residuals, dJ/dt v from their second differences along a motion at
constant rates. Pushes and accelerations follow from one least-squares solution of shortest multipliers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from mbsd.spatial import Body, Mechanism
from mbsd.spatial.results.solution import Solution

STEP = 2e-3
FIRST = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
SECOND = {0: -490 / 180, 1: 270 / 180, 2: -27 / 180, 3: 2 / 180}


@dataclass
class Pose:
    """Rotations (n, 3, 3) from the design pose and places (n, 3) of the centres of mass; ground is 0."""

    turned: np.ndarray
    place: np.ndarray

    def moved(self, way: np.ndarray) -> Pose:
        """Return the pose after a twist (6 n,): places, and rotation vectors in the world."""
        steps = np.vstack([np.zeros(6), way.reshape(-1, 6)])
        return Pose(Rotation.from_rotvec(steps[:, 3:]).as_matrix() @ self.turned, self.place + steps[:, :3])


class Independent:
    """A mechanism as bodies, and residuals of its joints."""

    def __init__(self, m: Mechanism) -> None:
        self.m, self.names = m, list(m.bodies)
        bodies = list(m.bodies.values())
        self.start = np.array([_world(body, body.com) for body in bodies])
        self.mass = np.array([body.mass for body in bodies])
        self.inertia = np.array([body.rotation @ np.array(body.inertia) @ body.rotation.T for body in bodies])
        self.residuals = [self._residual(joint) for joint in m.joints.values()]

    def _carried(self, marker: object) -> tuple[int, np.ndarray, np.ndarray]:
        """Return the body of a marker, its place from the centre of mass and its axes in the design pose."""
        body: Body = marker.body  # pyright: ignore[reportAttributeAccessIssue]
        b = self.names.index(body.name)
        place = _world(body, marker.place)  # pyright: ignore[reportAttributeAccessIssue]
        return b, place - self.start[b], body.rotation @ marker.axes  # pyright: ignore[reportAttributeAccessIssue]

    def _residual(self, joint: object) -> Callable[[Pose], np.ndarray]:
        kind = joint.kind.name  # pyright: ignore[reportAttributeAccessIssue]
        i, arm_i, axes_i = self._carried(joint.i)  # pyright: ignore[reportAttributeAccessIssue]
        j, arm_j, axes_j = self._carried(joint.j)  # pyright: ignore[reportAttributeAccessIssue]
        length = joint.params.get("length", 0.0)  # pyright: ignore[reportAttributeAccessIssue]

        def residual(pose: Pose) -> np.ndarray:
            a, b = pose.turned[i] @ axes_i, pose.turned[j] @ axes_j
            way = pose.place[j] + pose.turned[j] @ arm_j - pose.place[i] - pose.turned[i] @ arm_i
            same = np.array([a[:, 0] @ b[:, 2], a[:, 1] @ b[:, 2]])
            twist = np.array([a[:, 0] @ b[:, 1]])
            local = a.T @ way
            return {
                "spherical": lambda: way,
                "revolute": lambda: np.concatenate([way, same]),
                "universal": lambda: np.append(way, a[:, 2] @ b[:, 2]),
                "fixed": lambda: np.concatenate([way, same, twist]),
                "cylindrical": lambda: np.concatenate([local[:2], same]),
                "prismatic": lambda: np.concatenate([local[:2], same, twist]),
                "planar": lambda: np.concatenate([local[2:], same]),
                "point_on_plane": lambda: local[2:],
                "distance": lambda: np.array([np.linalg.norm(way) - length]),
            }[kind]()

        return residual

    def open_by(self, pose: Pose) -> np.ndarray:
        """Return the residuals (m,) of all joints."""
        return np.concatenate([np.zeros(0), *(residual(pose) for residual in self.residuals)])

    def accelerations(self, pose: Pose, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return accelerations (6 n,), and the forces and torques (6 n,) of joints about centres of mass."""
        n = len(v)
        columns = []
        for c in range(n):
            way = np.zeros(n)
            way[c] = STEP
            sides = [
                weight * (self.open_by(pose.moved(k * way)) - self.open_by(pose.moved(-k * way)))
                for k, weight in FIRST.items()
            ]
            columns.append(np.sum(sides, axis=0) / STEP)
        jac = np.array(columns).T.reshape(-1, n)
        bend, h = SECOND[0] * self.open_by(pose), STEP / max(1.0, float(np.abs(v).max(initial=0.0)))
        for k in (1, 2, 3):
            bend = bend + SECOND[k] * (self.open_by(pose.moved(k * h * v)) + self.open_by(pose.moved(-k * h * v)))
        masses, load = self._loads(pose, v)
        rows = len(jac)
        whole = np.block([[masses, jac.T], [jac, np.zeros((rows, rows))]])
        a = np.linalg.lstsq(whole, np.concatenate([load, -bend / h**2]), rcond=1e-9)[0][:n]
        return a, masses @ a - load

    def _loads(self, pose: Pose, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return masses (6 n, 6 n), and weight, forces and gyroscopic torques (6 n,)."""
        n = len(v)
        masses, load = np.zeros((n, n)), np.zeros((len(self.names), 6))
        speed = np.vstack([np.zeros(6), v.reshape(-1, 6)])
        for b in range(1, len(self.names)):
            c = 6 * b - 6
            inertia = pose.turned[b] @ self.inertia[b] @ pose.turned[b].T
            masses[c : c + 3, c : c + 3] = self.mass[b] * np.eye(3)
            masses[c + 3 : c + 6, c + 3 : c + 6] = inertia
            w = speed[b, 3:]
            load[b, :3], load[b, 3:] = self.mass[b] * np.array(self.m.gravity), -np.cross(w, inertia @ w)
        for force in self.m.forces.values():
            (i, arm_i, _), (j, arm_j, _) = self._carried(force.i), self._carried(force.j)
            arms = pose.turned[i] @ arm_i, pose.turned[j] @ arm_j
            rates = [speed[b, :3] + np.cross(speed[b, 3:], arm) for b, arm in zip((i, j), arms, strict=True)]
            p = force.params
            if force.kind.name == "drag":
                push = -p["damping"] * rates[1]
            else:
                way = pose.place[j] + arms[1] - pose.place[i] - arms[0]
                along = way / np.linalg.norm(way)
                rate = along @ (rates[1] - rates[0])
                push = -(p["stiffness"] * (np.linalg.norm(way) - p["length"]) + p["damping"] * rate) * along
            for b, arm, sign in ((i, arms[0], -1.0), (j, arms[1], 1.0)):
                load[b, :3] += sign * push
                load[b, 3:] += sign * np.cross(arm, push)
        return masses, load[1:].ravel()


def _world(body: Body, place: object) -> np.ndarray:
    return body.rotation @ np.array(place) + np.array(body.place)


def differences(m: Mechanism, sol: Solution) -> dict[str, float]:
    """Return how far a simulation is off: open joints, accelerations and pushes of joints, relative to the largest."""
    own = Independent(m)
    bodies = list(m.bodies.values())
    frames = [sol.place(body.marker(body.com)) for body in bodies]
    whole = [sol.body(body.name) for body in bodies]
    worst = {"open": 0.0, "acceleration": 0.0, "reaction": 0.0}
    for k in range(len(sol.t)):
        turned = np.array([frame.rotation[k] @ body.rotation.T for frame, body in zip(whole, bodies, strict=True)])
        pose = Pose(turned, np.array([frame.place[k] for frame in frames]))
        v = np.array([[*frame.velocity[k], *frame.w[k]] for frame in frames[1:]]).ravel()
        wanted, pushed = own.accelerations(pose, v)
        solved = np.array([[*frame.acceleration[k], *frame.alpha[k]] for frame in frames[1:]]).ravel()
        acting = np.zeros((len(bodies), 6))
        for name, joint in m.joints.items():
            view = sol.joint(name)
            for marker, sign in ((joint.i, -1.0), (joint.j, 1.0)):
                b = own.names.index(marker.body.name)
                arm = view.place[k] - pose.place[b]
                acting[b, :3] += sign * view.force[k]
                acting[b, 3:] += sign * (view.moment[k] + np.cross(arm, view.force[k]))
        size = 1.0 + np.abs(wanted).max()
        worst["open"] = max(worst["open"], float(np.abs(own.open_by(pose)).max(initial=0.0)))
        worst["acceleration"] = max(worst["acceleration"], float(np.abs(solved - wanted).max()) / size)
        off = np.abs(acting[1:].ravel() - pushed).max() / (1.0 + np.abs(pushed).max())
        worst["reaction"] = max(worst["reaction"], float(off))
    return worst
