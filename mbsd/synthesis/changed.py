"""A mechanism with other lengths and places, as a new one."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import replace

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.model.body import Body, Marker, rod_inertia
from mbsd.model.change import change
from mbsd.model.mechanism import Model, new_name, own_body

ROD_ALIKE = 1e-9
"""Relative difference below which a bar's inertia is that of a uniform rod."""


def changed(m: Model, values: Mapping[str, object]) -> Model:
    """A copy of ``m`` with lengths of bars and rods (one number, m) and places of joints and traced points ((x, y), m).

    A bar's new end moves whatever is at its end, forces included, and a uniform rod stays one; other masses are kept.
    Raises ModelError for a name of none.
    """
    out = copy.deepcopy(m)
    for name, value in values.items():
        if isinstance(value, tuple):
            put_place(out, name, value)
        elif name in out.joints and out.joints[name].kind.constraints == ("distance",):
            change(out, name, {"length": value})
        else:
            lengthen(out, out.known_body(name), float(value))  # pyright: ignore[reportArgumentType]
    return out


def put_place(m: Model, name: str, place: tuple[float, ...]) -> None:
    """Move a traced point, or the marker of a joint that ``batch`` moves, to a place (m) where it stands."""
    x, y = place
    if name in m.traces:
        m.traces[name] = replace(m.traces[name], x=x, y=y)
        return
    if name not in m.joints:
        raise ModelError(f"{m.name}: {no_such('joint or traced point', name, [*m.joints, *m.traces])}")
    joint = m.joints[name]
    first = joint.i.body is m.ground or joint.j.body is not m.ground
    side = "i" if first else "j"
    object.__setattr__(joint, side, replace(getattr(joint, side), x=x, y=y))


def lengthen(m: Model, body: Body, length: float) -> None:
    """Give a bar another length (m) where it stands."""
    old = body.length
    assert old is not None
    own: dict[str, object] = {"length": length}
    if body.com == (old / 2, 0.0):
        rod = rod_inertia(body.mass, old)
        if "com" not in body.derived:
            own["com"] = length / 2, 0.0
        if "inertia" not in body.derived and body.mass > 0 and abs(body.inertia - rod) <= ROD_ALIKE * rod:
            own["inertia"] = rod_inertia(body.mass, length)
    change(m, body.name, own)


def traced_copy(m: Model, name: str, marker: Marker) -> Model:
    """A copy of ``m`` that follows one more point. Raises ModelError for a marker of another mechanism."""
    own_body(m, marker.body, "fit_path: point")
    out = copy.deepcopy(m)
    new_name(out, name, "trace", out.traces)
    out.traces[name] = replace(marker, body=out.bodies[marker.body.name])
    return out
