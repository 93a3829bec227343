"""Every kind of joint, force and contact that has automatic parts: importing a line's module enters it."""

from mechanisms.stages.automatic.cams import (  # noqa: F401
    cam_solids,
    cams,  # cam and roller, cam and flat face
    geneva,  # Geneva
    geneva_solids,
)
from mechanisms.stages.automatic.pins import (  # noqa: F401
    bridge_solids,
    pin_hardware,
    pins,  # revolute, and the ends of rods
    pins_with_play,  # clearance joint
    welds,  # weld
)
from mechanisms.stages.automatic.pins.springs import (  # noqa: F401
    springs,  # springs, dampers and actuators between points
    stud_solids,
)
from mechanisms.stages.automatic.rolling import (  # noqa: F401
    contacts,  # discs on walls and roads, tyres
    rolling,  # discs on lines and terrains
    round_solids,
)
from mechanisms.stages.automatic.slides import (  # noqa: F401
    crossing_solids,
    curved_slots,  # point on a curve
    prismatic,  # prismatic
    slide_solids,
    slot_solids,
    slots,  # pin in slot
)
from mechanisms.stages.automatic.wheels import (  # noqa: F401
    gear_solids,
    gears,  # gear pair, rack and pinion, belt
    pulley_solids,
    rack_solids,
)
