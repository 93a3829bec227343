"""Contact by penalty of balls, discs, wheels and points with planes and height fields, and tyres.

The laws are in equations/contact.py:

    N = k d^p (1 + c d')        d: depth, d' its rate; p 1.5 of Hertz
    T = -mu N tanh(s / s_0)     s: sliding velocity; below s_0 bodies creep instead of sticking
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.base.arguments import number_array, positive_number
from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import add_force, not_negative, round_ends
from mbsd.spatial.model.force import Call, Force, ForceKind, no_rows, register_force
from mbsd.spatial.model.mechanism import Model

Heights = tuple[Any, Any, Any]
"""x (n,) and y (m,), equally spaced and rising, and heights (m, n), all in m."""
ROUND = ("ring", "radius", "stiffness", "exponent", "damping", "friction", "slip_speed")
PULLING = ("grip", "slope", "side_slope", "shape", "curvature", "standstill")


def _numbers(f: Force) -> list[float]:
    p = f.params
    numbers = [p.get(name, 0.0) for name in (*ROUND, *PULLING)]
    if p["heights"] is None:
        return [*numbers, *[0.0] * 6]
    x, y, z = (np.array(part, float) for part in p["heights"])
    return [*numbers, len(x), len(y), x[0], y[0], x[1] - x[0], y[1] - y[0], *z.ravel()]


CONTACT = register_force(
    ForceKind(
        "contact",
        no_rows,
        call=lambda f: Call("contact", (f.i, f.j), _numbers(f)),
        example=lambda m, i, j: m.contact(
            "example",
            i,
            j,
            at=(0.1, 0.2, 0.3),
            normal=(1, 2, -1),
            centre=(0.2, 0.3, 0.1),
            axis=(1, 0, 0),
            ring=2.0,
            radius=1.0,
            stiffness=50.0,
            damping=0.01,
            friction=0.3,
            slip_speed=0.5,
        ),
    )
)
TYRE = register_force(
    ForceKind(
        "tyre",
        no_rows,
        call=lambda f: Call("tyre", (f.i, f.j), _numbers(f)),
        example=lambda m, i, j: m.tyre(
            "example",
            i,
            j,
            at=(0.1, 0.2, 0.3),
            normal=(1, 2, -1),
            centre=(0.2, 0.3, 0.1),
            axis=(1, 0, 0),
            radius=2.0,
            stiffness=50.0,
            damping=1.0,
            standstill=0.5,
        ),
    )
)


@CONTACT.adds
def contact(
    m: Model, name: str, surface: Fixing, body: Fixing, stiffness: float, at: Place | None = None,
    normal: Direction | None = None, centre: Place | None = None, axis: Direction | None = None, radius: float = 0.0,
    ring: float = 0.0, exponent: float = 1.5, damping: float = 0.0, friction: float = 0.0, slip_speed: float = 1e-3,
    heights: Heights | None = None,
) -> Force:  # fmt: skip
    """A round body against a plane or a height field of another.

    The plane goes through ``at`` (m), with matter against its ``normal``; or it is that of a marker's x and y axes. The
    body is a ball of ``radius`` (m) about ``centre``, a point with 0, a disc of radius ``ring`` about ``axis``, or with
    both a ring with a round rim; of a marker place and z axis are taken. ``stiffness`` k (N/m^exponent), ``damping`` c
    (s/m), ``friction`` mu, ``slip_speed`` s_0 (m/s). ``heights``: x, y and heights over the plane (m), in its axes.
    A disc touches at its lowest point, so nothing holds one that lies flat.
    """
    what = f"{m.name}: force '{name}'"
    params = {"ring": ring, "radius": radius, "stiffness": stiffness, "damping": damping, "friction": friction}
    not_negative(what, **params)
    params |= {"exponent": exponent, "slip_speed": positive_number(f"{what}: slip_speed", slip_speed, "m/s")}
    if exponent < 1.0:
        raise ModelError(f"{what}: exponent is {exponent:g}; it must be 1 or more, 1.5 is that of Hertz")
    i, j = round_ends(m, what, surface, body, at, normal, centre, axis, ring > 0.0)
    return add_force(m, CONTACT, name, i, j, {**params, "heights": _heights(what, heights)})


@TYRE.adds
def tyre(
    m: Model, name: str, road: Fixing, wheel: Fixing, radius: float, stiffness: float, damping: float = 0.0,
    at: Place | None = None, normal: Direction | None = None, centre: Place | None = None,
    axis: Direction | None = None, rim: float = 0.0, grip: float = 1.0, slope: float = 10.0,
    side_slope: float | None = None, shape: float = 1.65, curvature: float = 0.97, standstill: float = 0.1,
    heights: Heights | None = None,
) -> Force:  # fmt: skip
    """A tyre of ``radius`` (m) about ``axis`` at ``centre`` on a road, given as for a contact.

    ``stiffness`` (N/m) and ``damping`` (N s/m) carry; ``grip`` D, ``slope`` B, ``shape`` C and ``curvature`` E of
    the magic formula pull by slip along and across the wheel, ``side_slope`` B across (default: ``slope``). ``rim`` (m)
    rounds the tread. Below ``standstill`` (m/s) slips stay finite. Forward is axis x normal.
    """
    what = f"{m.name}: force '{name}'"
    radius, rim = positive_number(f"{what}: radius", radius, "m"), float(rim)
    side_slope = slope if side_slope is None else side_slope
    params = {"stiffness": stiffness, "damping": damping, "grip": grip, "slope": slope, "side_slope": side_slope,
              "shape": shape, "radius": rim}  # fmt: skip
    not_negative(what, **params)
    if rim >= radius:
        raise ModelError(f"{what}: rim is {rim:g} m; it must be less than the radius, {radius:g} m")
    params |= {"ring": radius - rim, "curvature": curvature, "heights": _heights(what, heights)}
    params |= {"standstill": positive_number(f"{what}: standstill", standstill, "m/s")}
    return add_force(m, TYRE, name, *round_ends(m, what, road, wheel, at, normal, centre, axis, True), params)


def _heights(what: str, given: Heights | None) -> list[list[Any]] | None:
    """Return x, y and heights as lists. Raises ModelError."""
    if given is None:
        return None
    if not isinstance(given, tuple | list) or len(given) != 3:
        raise ModelError(f"{what}: heights are x (n,), y (m,) and z (m, n), such as (x, y, z)")
    x, y, z = (number_array(f"{what}: heights", part) for part in given)
    if x.ndim != 1 or y.ndim != 1 or min(len(x), len(y)) < 2 or z.shape != (len(y), len(x)):
        raise ModelError(f"{what}: heights have shapes {x.shape}, {y.shape} and {z.shape}; give (n,), (m,) and (m, n)")
    for steps in (np.diff(x), np.diff(y)):
        if not (steps > 0.0).all() or np.ptp(steps) > 1e-6 * steps.max():
            raise ModelError(f"{what}: x and y of heights must rise by equal steps")
    return [x.tolist(), y.tolist(), z.tolist()]
