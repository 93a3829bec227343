"""What files of versions 1 and 2 of data.json do not say: it follows from the kinds that there were then."""

from __future__ import annotations

import msgspec

from shared.contract.loads import EffortUnit, Pair, ValueUnit
from shared.contract.motion import Motion

PAIRS: dict[str, Pair] = {"revolute": "pin", "prismatic": "guide", "pin_in_slot": "slot"}
DRIVING = ("torque", "force", "actuator")


def completed(motion: Motion) -> Motion:
    """The motion with pairs and units; nothing is known of looks, or of what acts beside a marker."""
    if motion.schema_version >= 3:
        return motion
    replace = msgspec.structs.replace
    return replace(
        motion,
        joints={name: replace(one, pair=PAIRS.get(one.kind)) for name, one in motion.joints.items()},
        drivers={
            name: replace(one, **dict(zip(("unit", "effort_unit"), _units("angle" in one.kind), strict=True)))
            for name, one in motion.drivers.items()
        },
        forces={
            name: replace(
                one,
                unit=None if one.measures is None else _units(one.measures == "angle")[0],
                effort_unit=_units(one.measures == "angle")[1],
                drives=one.kind in DRIVING,
            )
            for name, one in motion.forces.items()
        },
    )


def _units(of_angle: bool) -> tuple[ValueUnit, EffortUnit]:
    return ("rad", "N m") if of_angle else ("m", "N")
