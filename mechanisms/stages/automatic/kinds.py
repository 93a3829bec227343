"""Kinds of joints, forces and contacts with automatic parts: importing a module enters its kinds."""

from mechanisms.stages.automatic import (  # noqa: F401
    cams,  # cams and Genevas
    outlines,  # outlines that touch
)
from mechanisms.stages.automatic.pins import (  # noqa: F401
    bridges,
    pin_solids,
    pins,  # revolute joints, the ends of rods, clearance joints
    springs,  # springs, dampers and actuators between points
    welds,
)
from mechanisms.stages.automatic.rolling import (  # noqa: F401
    contacts,  # discs on lines, terrains, walls and roads; tyres
    rounds,
)
from mechanisms.stages.automatic.slides import (  # noqa: F401
    curved_slots,  # points on curves
    rails,  # prismatic joints
    slides,
    slots,  # pins in slots
)
from mechanisms.stages.automatic.wheels import (  # noqa: F401
    gears,  # gear pairs, racks and pinions, belts
    pulleys,
    racks,
    wheels,
)
