"""Stops: an end of the way of an angle or a coordinate between two markers, as at the ends of a slider's guide.

    g = side (a - at)    constraint `turn`:   a, angle of marker j against marker i (rad, counted over whole turns)
    g = side (x - at)    constraint `linear`: x, of marker j along the x axis of marker i (m)

side = 1: the lower end; side = -1: the upper end.
"""

from __future__ import annotations

from mbsd.model.contacts.kind import ContactKind, register


def _side(params):
    return -1.0 if params["upper"] else 1.0


ANGLE_STOP = register(
    ContactKind(
        "angle_stop",
        ("turn",),
        example=lambda m, i, j: m.angle_stop("example", i, j, -3.0),
        numbers=lambda params: ((0.0, 0.0, _side(params), _side(params) * params["at"]),),
    )
)
COORDINATE_STOP = register(
    ContactKind(
        "coordinate_stop",
        ("linear",),
        example=lambda m, i, j: m.coordinate_stop("example", i, j, -3.0),
        numbers=lambda params: ((_side(params), 0.0, 0.0, _side(params) * params["at"]),),
    )
)
