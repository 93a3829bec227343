"""Fields that data.json of versions 1 and 2 lacks: they follow from the kinds of that time."""

from __future__ import annotations

import msgspec

from shared.contract.loads import EffortUnit, Pair, ValueUnit
from shared.contract.motion import Motion

PAIRS: dict[str, Pair] = {"revolute": "pin", "prismatic": "guide", "pin_in_slot": "slot"}
DRIVING = ("torque", "force", "actuator")


def completed(motion: Motion) -> Motion:
    """Return the motion with pairs and units.

    Nothing is known of looks, or of loads that act beside a marker.
    """
    if motion.schema_version >= 3:
        return motion
    replace = msgspec.structs.replace
    return replace(
        motion,
        joints={name: replace(joint, pair=PAIRS.get(joint.kind)) for name, joint in motion.joints.items()},
        drivers={
            name: replace(driver, **dict(zip(("unit", "effort_unit"), _units("angle" in driver.kind), strict=True)))
            for name, driver in motion.drivers.items()
        },
        forces={
            name: replace(
                force,
                unit=None if force.measures is None else _units(force.measures == "angle")[0],
                effort_unit=_units(force.measures == "angle")[1],
                drives=force.kind in DRIVING,
            )
            for name, force in motion.forces.items()
        },
    )


def _units(of_angle: bool) -> tuple[ValueUnit, EffortUnit]:
    return ("rad", "N m") if of_angle else ("m", "N")
