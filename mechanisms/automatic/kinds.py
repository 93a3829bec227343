"""Every kind of joint, force and contact that has parts by itself: importing a line's module enters it."""

from mechanisms.automatic import (  # noqa: F401
    cams,  # cam and roller, cam and flat face
    contacts,  # discs on walls and roads, tyres
    curved_slots,  # point on a curve
    gears,  # gear pair, rack and pinion, belt
    geneva,  # Geneva
    pins,  # revolute
    rolling,  # discs on lines and terrains
    slides,  # prismatic
    slots,  # pin in slot
    springs,  # springs, dampers and actuators between points
    welds,  # weld
)
