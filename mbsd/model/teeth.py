"""Wheels given by their teeth: pitch radii and centre distances.

    gears and racks    r = module z / 2                        z: teeth;  module: pitch diameter per tooth (m)
    belts and chains   r = pitch z / (2 pi)                    pitch: from tooth to tooth along the belt (m)
    centre distance    module (z_i + z_j) / 2,   of a ring gear and the pinion in it module (z_i - z_j) / 2

Source: ISO 21771 (gears), ISO 5294 (belts).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

FEWEST = 3
"""Teeth of a wheel."""
PLAY = 1e-3
"""Part of the module by which a distance may be off."""
ROUNDED = 1e-3
"""Part of the smaller gear's radius by which a distance may be off where radii are given: people round them."""


def with_radii(params: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a joint's params with pitch radii (m) from teeth: ``radius_i``, ``radius_j``, ``radius``."""
    teeth = params.get("teeth")
    if teeth is None:
        return params
    tooth = params["module"] / 2 if "module" in params else params["pitch"] / (2 * math.pi)
    if isinstance(teeth, int):
        return {**params, "radius": tooth * teeth}
    return {**params, "radius_i": tooth * teeth[0], "radius_j": tooth * teeth[1]}


def gear_problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    """Why two gears with their centres (x, y) apart (m) cannot mesh."""
    distance, internal = math.hypot(x, y), params["internal"]
    sign, between = (-1, "-") if internal else (1, "+")
    if params.get("teeth") is None:
        first, second = params["radius_i"], params["radius_j"]
        wanted = first + sign * second
        if abs(distance - wanted) <= ROUNDED * second:
            return None
        share = distance / (first + sign * second)
        return (
            f"its centres are {distance:.6g} m apart, but radii of {first:g} m and {second:g} m "
            f"{'of a ring and the gear in it ' if internal else ''}touch at {first:g} {between} {second:g} = "
            f"{wanted:.6g} m. Move a centre, or give radii with this {'difference' if internal else 'sum'}: the same "
            f"ratio has radius_i={first * share:.6g}, radius_j={second * share:.6g}"
            + ("" if internal else _ring(distance, first, second))
        )
    (first, second), module = params["teeth"], params["module"]
    wanted = module * (first + sign * second) / 2
    if abs(distance - wanted) <= PLAY * module:
        return None
    return (
        f"its centres are {distance:.6g} m apart, but a module of {module:g} m and {first} {between} {second} teeth "
        f"need {module:g} * ({first} {between} {second}) / 2 = {wanted:.6g} m. Move a centre or change module or "
        "teeth. Give gears with profile shift by the radii at which they roll, radius_i= and radius_j="
    )


def _ring(distance: float, first: float, second: float) -> str:
    """A remedy where the centres are the difference of the radii apart."""
    if abs(distance - abs(first - second)) > ROUNDED * min(first, second):
        return ""
    order = "" if first > second else ", with the ring first"
    return f"; if one gear is a ring around the other, say internal=True{order}"


def belt_problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    """Why a belt cannot go round two pulleys with their centres (x, y) apart (m)."""
    sized, distance = with_radii(params), math.hypot(x, y)
    first, second = sized["radius_i"], sized["radius_j"]
    least = first + second if params["crossed"] else abs(first - second)
    if distance > least:
        return None
    why = "cross only between pulleys that are apart" if params["crossed"] else "lie on pulleys of which neither"
    return (
        f"its centres are {distance:.6g} m apart, but strands {why}{'' if params['crossed'] else ' is in the other'}: "
        f"with radii of {first:g} m and {second:g} m they need more than {least:.6g} m. Move a centre or give smaller "
        "radii"
    )


def rack_problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    """Why a pinion with its centre at (x, y) in the axes of its rack (m) cannot mesh."""
    radius = with_radii(params)["radius"]
    side = (
        " It is on the other side of the rack: turn the rack's marker by pi, rack.at(x, y, angle + pi), so that its y "
        "axis points to the pinion."
        if y < 0
        else ""
    )
    if params.get("teeth") is None:
        if abs(y - radius) <= ROUNDED * radius:
            return None
        return (
            f"the pinion's centre is {y:.6g} m above the rack's x axis, its pitch line; it must be its radius of "
            f"{radius:g} m above.{side} Move the rack's marker or the pinion, or change radius"
        )
    teeth, module = params["teeth"], params["module"]
    if abs(y - radius) <= PLAY * module:
        return None
    return (
        f"the pinion's centre is {y:.6g} m above the rack's x axis, its pitch line, but a module of {module:g} m and "
        f"{teeth} teeth need {module:g} * {teeth} / 2 = {radius:.6g} m.{side} Move the rack's marker or the pinion, or "
        "change module or teeth. Give a pinion with profile shift by the radius at which it rolls, radius="
    )
