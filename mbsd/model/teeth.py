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


def with_radii(params: Mapping[str, Any]) -> Mapping[str, Any]:
    """The params of a joint with the pitch radii (m) of wheels that are given by teeth: ``radius_i``, ``radius_j``,
    ``radius``."""
    teeth = params.get("teeth")
    if teeth is None:
        return params
    tooth = params["module"] / 2 if "module" in params else params["pitch"] / (2 * math.pi)
    if isinstance(teeth, int):
        return {**params, "radius": tooth * teeth}
    return {**params, "radius_i": tooth * teeth[0], "radius_j": tooth * teeth[1]}


def gear_problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    """Why two gears with their centres (x, y) apart (m) cannot mesh, if they are given by teeth."""
    if params.get("teeth") is None:
        return None
    (first, second), module = params["teeth"], params["module"]
    sign, between = (-1, "-") if params["internal"] else (1, "+")
    distance, wanted = math.hypot(x, y), module * (first + sign * second) / 2
    if abs(distance - wanted) <= PLAY * module:
        return None
    return (
        f"its centres are {distance:.6g} m apart, but a module of {module:g} m and {first} {between} {second} teeth "
        f"want {module:g} * ({first} {between} {second}) / 2 = {wanted:.6g} m. Move a centre or change module or "
        "teeth; gears with profile shift are given by the radii at which they roll, radius_i= and radius_j="
    )


def rack_problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    """Why a pinion with its centre at (x, y) in the axes of its rack (m) cannot mesh, if it is given by teeth."""
    if params.get("teeth") is None:
        return None
    teeth, module = params["teeth"], params["module"]
    wanted = module * teeth / 2
    if abs(y - wanted) <= PLAY * module:
        return None
    return (
        f"the pinion's centre is {y:.6g} m above the rack's x axis, its pitch line, but a module of {module:g} m and "
        f"{teeth} teeth want {module:g} * {teeth} / 2 = {wanted:.6g} m. Move the rack's marker or the pinion, or "
        "change module or teeth; a pinion with profile shift is given by the radius at which it rolls, radius="
    )
