"""Wheels that their cable leaves: how far it lies around each wheel between two spans.

    wrap = sign(s) (phi_out - phi_in)      counted from 0 .. 2 pi at the start

s is the signed radius of the wheel, phi the directions in which the cable comes and goes. Where the wrap falls to zero
the cable lies straight beside the wheel; beyond, the equations of the spans would press it through the wheel.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.reactions import marker_places
from mbsd.base.errors import LimitError
from mbsd.model.cables import signed_radii, span_direction

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.body import Marker
    from mbsd.model.joint import Joint

STRAIGHT = 1e-9
"""rad: a cable that is bent by less the other way is straight."""


def refuse_left_wheels(packed: Packed, times: np.ndarray, q: np.ndarray) -> None:
    """Raise LimitError at the first time (s) at which a cable leaves a wheel, along poses q (T, 3 nb)."""
    spans = [
        (joint, *(int(marker) for marker in packed.markers[k][:2]))
        for k, joint in enumerate(packed.joints)
        if joint.kind.constraints == ("span",)
    ]
    first: tuple[float, Joint, Joint] | None = None
    for span, i, middle in spans:
        for other, _, j in spans:
            if other is span or not _on_one_wheel(span, other):
                continue
            wrap = _wrap(packed, q, (span, other), (i, middle, j))
            left = np.flatnonzero(wrap < -STRAIGHT)
            if not len(left):
                continue
            at = int(left[0])
            share = 1.0 if at == 0 else wrap[at - 1] / (wrap[at - 1] - wrap[at])
            time = float(times[max(at - 1, 0)] + share * (times[at] - times[max(at - 1, 0)]))
            if first is None or time < first[0]:
                first = time, span, other
    if first is None:
        return
    time, span, other = first
    raise LimitError(
        f"{packed.name}: at t = {time:.6g} s the cable leaves '{span.j.body.name}' between '{span.name}' and "
        f"'{other.name}': it is straight there. End the motion before, or move a wheel."
    )


def _on_one_wheel(span: Joint, other: Joint) -> bool:
    """Return True if a span ends on the wheel on which the other begins."""
    before, after = signed_radii(span.params)[1], signed_radii(other.params)[0]
    return before == after != 0.0 and _place(span.j) == _place(other.i)


def _place(marker: Marker) -> tuple[str, float, float]:
    return marker.body.name, marker.x, marker.y


def _wrap(packed: Packed, q: np.ndarray, spans: tuple[Joint, Joint], markers: tuple[int, int, int]) -> np.ndarray:
    """Return (T,) how far the cable lies around the middle of three wheels (rad)."""
    places = [marker_places(packed, q, marker) for marker in markers]
    directions = []
    for joint, a, b in zip(spans, places[:2], places[1:], strict=True):
        directions.append(span_direction(b - a, signed_radii(joint.params)))
    sign = math.copysign(1.0, signed_radii(spans[0].params)[1])
    wrap = np.unwrap(sign * (directions[1] - directions[0]))
    return wrap - 2.0 * math.pi * math.floor((float(wrap[0]) + STRAIGHT) / (2.0 * math.pi))
