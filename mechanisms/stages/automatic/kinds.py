"""Every kind of joint, force and contact that has parts by itself: importing a line's module enters it."""

from mechanisms.stages.automatic.cams import (  # noqa: F401
    cams,  # cam and roller, cam and flat face
    geneva,  # Geneva
)
from mechanisms.stages.automatic.pins import (  # noqa: F401
    pins,  # revolute, and the ends of rods
    springs,  # springs, dampers and actuators between points
    welds,  # weld
)
from mechanisms.stages.automatic.rolling import (  # noqa: F401
    contacts,  # discs on walls and roads, tyres
    rolling,  # discs on lines and terrains
)
from mechanisms.stages.automatic.slides import (  # noqa: F401
    curved_slots,  # point on a curve
    slides,  # prismatic
    slots,  # pin in slot
)
from mechanisms.stages.automatic.wheels import (  # noqa: F401
    gears,  # gear pair, rack and pinion, belt
)
