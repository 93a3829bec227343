"""A small four-bar for the picture tests: its motion in closed form, its solids from trimesh."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from shared.contract import (
    BodyMotion,
    BodyParts,
    Diagnostics,
    DriverMotion,
    Energy,
    JointMotion,
    Mass,
    Motion,
    Parts,
    Piece,
    PointMotion,
    Provenance,
    write_motion,
    write_parts,
)
from shared.files import file_hash
from shared.paths import Out
from shared.shot import Shot, write_shot

GROUND, CRANK, COUPLER, ROCKER = 0.120, 0.040, 0.120, 0.090
POINT = (0.06, 0.03)
LAYERS = {"crank": 0.018, "coupler": 0.028, "rocker": 0.018}


def angles(crank: float) -> tuple[float, float]:
    """Coupler and rocker angle (rad) of the open branch, by intersecting two circles."""
    bx, by = CRANK * math.cos(crank), CRANK * math.sin(crank)
    dx, dy = GROUND - bx, -by
    distance = math.hypot(dx, dy)
    inner = math.acos((COUPLER**2 + distance**2 - ROCKER**2) / (2 * COUPLER * distance))
    coupler = math.atan2(dy, dx) + inner
    cx, cy = bx + COUPLER * math.cos(coupler), by + COUPLER * math.sin(coupler)
    return coupler, math.atan2(cy, cx - GROUND)


def rates(speed: float, crank: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles, angular velocities and accelerations of crank, coupler, rocker at constant crank speed."""
    coupler, rocker = angles(crank)
    theta = np.array([crank, coupler, rocker])
    lengths = np.array([CRANK, COUPLER, -ROCKER])
    direction = np.stack([np.cos(theta), np.sin(theta)])
    normal = np.stack([-np.sin(theta), np.cos(theta)])
    matrix = normal[:, 1:] * lengths[1:]
    omega = np.array([speed, *np.linalg.solve(matrix, -normal[:, 0] * lengths[0] * speed)])
    alpha = np.array([0.0, *np.linalg.solve(matrix, direction @ (lengths * omega**2))])
    return theta, omega, alpha


def motion(samples: int = 361, speed: float = 2 * math.pi) -> Motion:
    """One turn of the crank; reactions and energies are zero, no picture shows them."""
    period = 2 * math.pi / speed
    time = [period * i / (samples - 1) for i in range(samples)]
    at = [rates(speed, speed * t) for t in time]
    theta, omega, alpha = (
        np.unwrap(np.array([row[k] for row in at]), axis=0) if k == 0 else np.array([row[k] for row in at])
        for k in range(3)
    )

    def arm(k: int, length: float, along: float = 0.0):
        """Position, velocity, acceleration of a vector (length, along) fixed to body k."""
        c, s = np.cos(theta[:, k]), np.sin(theta[:, k])
        r = np.stack([c * length - s * along, s * length + c * along], 1)
        n = np.stack([-r[:, 1], r[:, 0]], 1)
        return r, n * omega[:, k, None], n * alpha[:, k, None] - r * omega[:, k, None] ** 2

    zero = np.zeros((samples, 2))
    a = (zero, zero, zero)
    b = arm(0, CRANK)
    d = (zero + np.array([GROUND, 0.0]), zero, zero)
    frames = {"crank": (a, 0), "coupler": (b, 1), "rocker": (d, 2)}
    bodies = {
        name: BodyMotion(
            x=p[:, 0].tolist(), y=p[:, 1].tolist(), theta=theta[:, k].tolist(),
            vx=v[:, 0].tolist(), vy=v[:, 1].tolist(), omega=omega[:, k].tolist(),
            ax=acc[:, 0].tolist(), ay=acc[:, 1].tolist(), alpha=alpha[:, k].tolist(),
            z=LAYERS[name], mass=0.1, com=(0.0, 0.0), inertia=1e-5,
        )
        for name, ((p, v, acc), k) in frames.items()
    }  # fmt: skip
    c = [u + w for u, w in zip(d, arm(2, ROCKER), strict=True)]
    none = [0.0] * samples

    def joint(first: str, second: str, p: np.ndarray) -> JointMotion:
        return JointMotion(
            kind="revolute",
            bodies=(first, second),
            x=p[:, 0].tolist(),
            y=p[:, 1].tolist(),
            fx=none,
            fy=none,
            torque=none,
        )

    trace = [u + w for u, w in zip(b, arm(1, *POINT), strict=True)]
    return Motion(
        mechanism="four_bar",
        provenance=Provenance(inputs="0" * 64, versions={}),
        gravity=(0.0, 0.0),
        period=period,
        time=time,
        bodies=bodies,
        joints={
            "A": joint("ground", "crank", zero),
            "B": joint("crank", "coupler", b[0]),
            "C": joint("coupler", "rocker", c[0]),
            "D": joint("ground", "rocker", d[0]),
        },
        drivers={"motor": DriverMotion(kind="angle", value=theta[:, 0].tolist(), effort=none, power=none)},
        points={
            "P": PointMotion(
                body="coupler",
                x=trace[0][:, 0].tolist(), y=trace[0][:, 1].tolist(),
                vx=trace[1][:, 0].tolist(), vy=trace[1][:, 1].tolist(),
                ax=trace[2][:, 0].tolist(), ay=trace[2][:, 1].tolist(),
            )
        },
        energy=Energy(kinetic=none, potential=none),
        diagnostics=Diagnostics(
            position_residual=0.0, velocity_residual=0.0, acceleration_residual=0.0, power_residual=0.0,
            dof=1, redundant=[], singularity_margin=[1.0] * samples,
        ),
    )  # fmt: skip


def solids() -> dict[str, dict[str, tuple[Any, str]]]:
    """Body -> piece -> (mesh in mm, material). Every moving body carries a small ball at each of its joints."""
    from trimesh import creation
    from trimesh.transformations import translation_matrix as move

    def box(length: float, width: float, z: float, height: float, start: float = 0.0):
        mesh = creation.box((length + width, width, height))
        mesh.apply_transform(move((start + length / 2, 0, z)))
        return mesh

    def ball(x: float, y: float, z: float):
        mesh = creation.icosphere(subdivisions=2, radius=3.0)
        mesh.apply_transform(move((x, y, z)))
        return mesh

    def link(name: str, length: float, material: str) -> dict[str, tuple[Any, str]]:
        z = LAYERS[name] * 1000
        return {
            name: (box(length, 16, z, 8), material),
            "start": (ball(0, 0, z + 8), "brass"),
            "end": (ball(length, 0, z + 8), "brass"),
        }

    return {
        "ground": {"base": (box(GROUND * 1000, 60, 5, 10), "aluminium_black")},
        "crank": link("crank", CRANK * 1000, "aluminium_orange"),
        "coupler": link("coupler", COUPLER * 1000, "aluminium"),
        "rocker": link("rocker", ROCKER * 1000, "aluminium_blue"),
    }


def write(out: Out, shot: Shot | None = None) -> None:
    """data.json, parts.json with its STL files, and shot.json under ``out``."""
    write_motion(out.motion, motion())
    bodies = {}
    mass = Mass(mass=0.1, com=(0.0, 0.0), inertia=1e-5, volume=1e-5)
    out.parts_folder.mkdir(parents=True, exist_ok=True)
    for body, pieces in solids().items():
        made = {}
        for name, (mesh, material) in pieces.items():
            path: Path = out.parts_folder / f"{body}-{name}.stl"
            mesh.export(path)
            low, high = mesh.bounds[:, 2] / 1000
            made[name] = Piece(
                material=material, stl=path.name, step=path.with_suffix(".step").name, mass=mass,
                z_range=(float(low), float(high)), triangles=len(mesh.faces), stl_sha256=file_hash(path),
            )  # fmt: skip
        bodies[body] = BodyParts(pieces=made, mass=mass, z=LAYERS.get(body, 0.0))
    write_parts(
        out.parts, Parts(mechanism="four_bar", provenance=Provenance(inputs="0" * 64, versions={}), bodies=bodies)
    )
    write_shot(out.shot, shot or Shot())
