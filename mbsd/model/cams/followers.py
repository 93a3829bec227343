"""Outlines of disc cams for four followers. The cam turns counter-clockwise about the origin by theta.

World axes at the cam's centre; s is the lift, R_b the base radius, R_r that of the roller; w is the roller's centre.

    roller               w = (e, d + s),  d^2 = (R_b + R_r)^2 - e^2            moves along y, offset e
    oscillating_roller   w = (f - l cos psi, l sin psi),  psi = psi_0 + s      arm l about the pivot (f, 0)
    pitch curve          P = R(-theta) w;  outline P - R_r n,  n the outward normal

    flat                 h = R_b + s,  normal at phi = pi / 2 - theta          face across y
    oscillating_flat     h = f sin psi - b,  phi = pi / 2 - psi - theta        face at b from a line through (f, 0)
    outline              h n + h' n_perp,  radius of curvature h + h''          ' by phi

psi is the arm's angle from the line pivot to cam; psi_0 puts the follower on the base circle. Source: Norton, Design of
Machinery, ch. 8; Gonzalez-Palacios, Angeles, Cam Synthesis, 1993, ch. 3.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.body import finite_number
from mbsd.model.cams.lift import Lift
from mbsd.model.cams.profile import CamProfile
from mbsd.model.laws.numbers import hermite_coefficients


def roller_cam(lift: Lift, base_radius: float, roller_radius: float, offset: float = 0.0) -> CamProfile:
    """Return a cam for a translating roller whose line is ``offset`` (m) right of the cam's centre.

    Sizes are in m.

    At cam angle 0 and lift 0 the roller's centre is at (offset, sqrt((base + roller)^2 - offset^2)).
    """
    sizes = _sizes("roller_cam", lift, base_radius=base_radius, roller_radius=roller_radius)
    sizes["offset"] = finite_number("roller_cam: offset", offset)
    reach = base_radius + roller_radius
    if abs(offset) >= reach:
        raise ModelError(f"roller_cam: offset {offset:g} m is outside base and roller radius together, {reach:g} m")
    height = math.sqrt(reach**2 - offset**2)

    def centre(s: np.ndarray) -> np.ndarray:
        out = np.zeros((*s.shape[:-1], 2, 4))
        out[..., 0, 0] = offset
        out[..., 1, :] = s
        out[..., 1, 0] += height
        return out

    return _rolled("roller", lift, sizes, centre, lambda s: np.broadcast_to([0.0, 1.0], (*s.shape[:-1], 2)))


def oscillating_roller_cam(
    lift: Lift, base_radius: float, roller_radius: float, arm: float, pivot_distance: float
) -> CamProfile:
    """A cam for a roller on an arm (m) about a pivot at (pivot_distance, 0); the lift is an angle (rad).

    The arm points from the pivot up and back to the cam, at pi - psi in the world.
    """
    sizes = _sizes(
        "oscillating_roller_cam",
        lift,
        base_radius=base_radius,
        roller_radius=roller_radius,
        arm=arm,
        pivot_distance=pivot_distance,
    )
    cosine = (pivot_distance**2 + arm**2 - (base_radius + roller_radius) ** 2) / (2 * pivot_distance * arm)
    if not -1 < cosine < 1:
        raise ModelError(
            f"oscillating_roller_cam: an arm of {arm:g} m about a pivot {pivot_distance:g} m away does not put its "
            f"roller on a base circle of {base_radius:g} m; change one of them"
        )
    rest = math.acos(cosine)

    def centre(s: np.ndarray) -> np.ndarray:
        psi, p1, p2, p3 = np.moveaxis(s, -1, 0)
        sine, cos = np.sin(rest + psi), np.cos(rest + psi)
        along = np.stack([cos, -sine * p1, -cos * p1**2 - sine * p2, sine * (p1**3 - p3) - 3 * cos * p1 * p2], axis=-1)
        up = np.stack([sine, cos * p1, -sine * p1**2 + cos * p2, -cos * (p1**3 - p3) - 3 * sine * p1 * p2], axis=-1)
        out = np.stack([-arm * along, arm * up], axis=-2)
        out[..., 0, 0] += pivot_distance
        return out

    def way(s: np.ndarray) -> np.ndarray:
        return np.stack([np.sin(rest + s[..., 0]), np.cos(rest + s[..., 0])], axis=-1)

    return _rolled("oscillating_roller", lift, sizes, centre, way)


def flat_cam(lift: Lift, base_radius: float) -> CamProfile:
    """A cam for a translating flat face across its motion (along y). Sizes in m."""
    sizes = _sizes("flat_cam", lift, base_radius=base_radius)

    def support(theta: np.ndarray, s: np.ndarray) -> np.ndarray:
        return np.stack([math.pi / 2 - theta, base_radius + s[..., 0], -s[..., 1], s[..., 2]], axis=-1)

    return _faced("flat", lift, sizes, support, lambda theta, s, place: np.zeros(len(theta)))


def oscillating_flat_cam(lift: Lift, base_radius: float, pivot_distance: float, face_offset: float = 0.0) -> CamProfile:
    """A cam for a flat face on an arm about a pivot at (pivot_distance, 0); the lift is an angle (rad).

    ``face_offset`` (m): how far the face is from the line through the pivot, towards the cam.
    """
    sizes = _sizes("oscillating_flat_cam", lift, base_radius=base_radius, pivot_distance=pivot_distance)
    sizes["face_offset"] = finite_number("oscillating_flat_cam: face_offset", face_offset)
    sine = (base_radius + face_offset) / pivot_distance
    if not -1 < sine < 1:
        raise ModelError(
            f"oscillating_flat_cam: base_radius + face_offset = {base_radius + face_offset:g} m must be below "
            f"pivot_distance = {pivot_distance:g} m"
        )
    rest = math.asin(sine)

    def support(theta: np.ndarray, s: np.ndarray) -> np.ndarray:
        psi, p1, p2 = rest + s[..., 0], s[..., 1], s[..., 2]
        if (1 + p1).min() <= 0:
            raise ModelError(
                f"oscillating_flat_cam: the lift falls by {-p1.min():.4g} rad per rad of the cam; a flat face leaves "
                "it from 1 on: let it fall over a wider angle"
            )
        h = pivot_distance * np.sin(psi) - face_offset
        first = -pivot_distance * np.cos(psi) * p1 / (1 + p1)
        second = pivot_distance * (-np.sin(psi) * (p1 / (1 + p1)) ** 2 + np.cos(psi) * p2 / (1 + p1) ** 3)
        return np.stack([math.pi / 2 - psi - theta, h, first, second], axis=-1)

    def pressure(theta: np.ndarray, s: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Between the normal and the way of the arm's point at ``place`` (world)."""
        psi = rest + s[..., 0]
        way = np.stack([place[:, 1], pivot_distance - place[:, 0]], axis=-1)
        normal = np.stack([np.sin(psi), np.cos(psi)], axis=-1)
        return np.arctan2(way[:, 0] * normal[:, 1] - way[:, 1] * normal[:, 0], (way * normal).sum(axis=1))

    return _faced("oscillating_flat", lift, sizes, support, pressure)


def cam_from(data: Mapping[str, Any]) -> CamProfile:
    """The cam of plain data, as CamProfile.data gives it."""
    if not isinstance(data, Mapping):
        raise ModelError(f"cam: {shown(data)} is no cam; give what CamProfile.data holds")
    makers = {
        "roller": roller_cam,
        "flat": flat_cam,
        "oscillating_roller": oscillating_roller_cam,
        "oscillating_flat": oscillating_flat_cam,
    }
    rest = {key: value for key, value in data.items() if key not in ("follower", "lift")}
    follower = data.get("follower")
    if not isinstance(follower, str) or follower not in makers:
        raise ModelError(f"cam: {no_such('follower', follower, makers)}")
    if "lift" not in data:
        raise ModelError("cam: the lift is missing; keep what CamProfile.data gives as it is")
    maker = makers[follower]
    known = list(inspect.signature(maker).parameters)[1:]
    for key in rest:
        if key not in known:
            raise ModelError(f"cam: {follower}: {no_such('argument', key, known)}")
    missing = [key for key in known if key not in rest and key not in ("offset", "face_offset")]
    if missing:
        raise ModelError(f"cam: {follower}: {missing[0]} is missing; keep what CamProfile.data gives as it is")
    return maker(Lift.from_data(data["lift"]), **rest)


def _sizes(what: str, lift: Lift, **sizes: float) -> dict[str, float]:
    if not isinstance(lift, Lift):
        raise ModelError(f"{what}: the lift is {shown(lift)}; make one with Lift.of(...) or Lift.table(...)")
    out = {key: finite_number(f"{what}: {key}", value) for key, value in sizes.items()}
    for key, value in out.items():
        if value <= 0:
            raise ModelError(f"{what}: {key} is {value:g} m; it must be positive")
    return out


def _turned(theta: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """World vectors (..., 2) in the frame of a cam turned by theta (...)."""
    c, s = np.cos(theta), np.sin(theta)
    return np.stack([c * vectors[..., 0] + s * vectors[..., 1], c * vectors[..., 1] - s * vectors[..., 0]], axis=-1)


def _rolled(follower: str, lift: Lift, sizes: dict[str, float], centre: Any, way: Any) -> CamProfile:
    """Return the profile from the roller's centre w (..., 2, 4) in the world, with derivatives.

    ``way`` (..., 2) is the direction in which the centre moves.
    """
    from mbsd.model.plane_curves import curve_numbers

    breaks, ends = lift.pieces()
    theta = np.stack([breaks[:-1], breaks[1:]], axis=1)
    w = np.moveaxis(centre(ends), -1, 0)
    across = np.stack([-w[..., 1], w[..., 0]], axis=-1)
    # P = R(-theta) w, so P' = R(-theta) (w' - w_perp)
    path = [_turned(theta, w[0]), _turned(theta, w[1] - across[0]), _turned(theta, w[2] - 2 * across[1] - w[0])]
    samples = np.stack(path, axis=-1)
    pieces = hermite_coefficients(np.diff(breaks), samples[:, 0], samples[:, 1])
    p, dp, ddp = (part[:, 0] for part in path)
    speed = np.hypot(*dp.T)
    normal = np.stack([-dp[:, 1], dp[:, 0]], axis=1) / speed[:, None]  # P runs clockwise: outside is on its left
    bent = -(dp[:, 0] * ddp[:, 1] - dp[:, 1] * ddp[:, 0]) / speed**3
    with np.errstate(divide="ignore"):
        radius = 1 / bent - sizes["roller_radius"]
    moves = _turned(theta[:, 0], way(ends[:, 0]))
    pressure = np.arctan2(moves[:, 0] * normal[:, 1] - moves[:, 1] * normal[:, 0], (moves * normal).sum(axis=1))
    return CamProfile(
        follower=follower,
        lift=lift,
        sizes=sizes,
        angle=breaks[:-1],
        pitch=p,
        outline=p - sizes["roller_radius"] * normal,
        pressure_angle=pressure,
        curvature_radius=radius,
        numbers=curve_numbers(breaks, pieces, closed=True, distance=0.0, radius=0.0),
    )


def _faced(follower: str, lift: Lift, sizes: dict[str, float], support: Any, pressure: Any) -> CamProfile:
    """Return the profile from the support function.

    ``support`` (..., 4) has the direction phi, h and its two derivatives by phi, in the cam's frame.
    """
    breaks, ends = lift.pieces()
    theta = np.stack([breaks[:-1], breaks[1:]], axis=1)
    values = support(theta, ends)
    phi = values[..., 0]  # falls with theta: the pieces are taken from the last to the first
    pieces = hermite_coefficients((phi[:, 0] - phi[:, 1])[::-1], values[::-1, 1, 1:], values[::-1, 0, 1:])
    table = np.column_stack([phi[::-1, 1], pieces])
    h, first, second = values[:, 0, 1:].T
    n = np.stack([np.cos(phi[:, 0]), np.sin(phi[:, 0])], axis=1)
    outline = h[:, None] * n + first[:, None] * np.stack([-n[:, 1], n[:, 0]], axis=1)
    world = _turned(-breaks[:-1], outline)
    return CamProfile(
        follower=follower,
        lift=lift,
        sizes=sizes,
        angle=breaks[:-1],
        pitch=outline,
        outline=outline,
        pressure_angle=pressure(breaks[:-1], ends[:, 0], world),
        curvature_radius=h + second,
        numbers=np.concatenate([[len(table)], table.ravel()]),
    )
