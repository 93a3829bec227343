"""Which material each body gets where nobody says: driven and free ones orange, on ground colours, others metal."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbsd import Mechanism

DRIVEN = "aluminium_orange"
ON_GROUND = ("aluminium_blue", "aluminium_red", "aluminium_green", "aluminium_violet")
ROD = "steel"
BETWEEN = ("aluminium", "aluminium_gold")
FREE = ("aluminium_orange", "aluminium_blue", "aluminium_gold", "aluminium_green", "aluminium_red", "aluminium_violet")


def materials(m: Mechanism) -> dict[str, str]:
    """By moving body; colours are used in turn."""
    held = {name for joint in m.joints.values() for name in joint.bodies}
    driven = {name for driver in m.drivers.values() for name in driver.bodies} - {"ground"}
    grounded = {name for joint in m.joints.values() if "ground" in joint.bodies for name in joint.bodies} - {"ground"}
    found: dict[str, str] = {}
    turns = {"ground": 0, "between": 0, "free": 0}
    for name in m.bodies:
        if name == "ground":
            continue
        if name not in held:
            found[name] = FREE[turns["free"] % len(FREE)]
            turns["free"] += 1
        elif name in driven and name in grounded:
            found[name] = DRIVEN
        elif name in grounded:
            found[name] = ON_GROUND[turns["ground"] % len(ON_GROUND)]
            turns["ground"] += 1
        else:
            found[name] = BETWEEN[turns["between"] % len(BETWEEN)]
            turns["between"] += 1
    return found
