"""Cables over pulleys: which pulleys there are, the room of the strands, and the studs that hold the ends."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.body import Marker
from mbsd.model.cables import seen_span, signed_radii
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.items import Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.planar import Rounded
from mechanisms.stages.automatic.layout.sizes import Extent, extent
from mechanisms.stages.automatic.pins.springs import Stud
from mechanisms.stages.automatic.wheels.pulleys import BELT, LEAST, Pulley
from shared.contract.geometry import rows_of_spans, span_ends
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# A cable lies in one layer: its pulleys are grooved for it, and its strands keep other bodies out of that layer. A drum
# or pulley that two cables share has a groove for each, in layers of their own. What ends on a body is held by a stud,
# as a rope between two points is; the film draws the cable itself (render/film/tubes/cables.py).

SPANS, SLACK_SPANS = "cable_span", "slack_span"
type _Wheel = tuple[str, float, float, float]
SAME = 0.02
"""Wheels about places that are nearer (rmm) are one."""


@dataclass(frozen=True, eq=False)
class Cable(Feature):
    """A chain of spans: pulleys and strands, and what it is fixed to."""

    spans: tuple[Joint, ...]
    pulleys: tuple[Pulley, ...]
    """In its order; each wheel once."""
    ends: tuple[Marker, ...]
    """Points of bodies to which it is tied."""
    radius: float = BELT

    @property
    def force(self) -> str:
        """Its name, by which the film finds where it lies."""
        return self.spans[0].name

    @property
    def layer(self) -> str:
        """The name of its layer: that of its pulleys."""
        return self.pulleys[0].layer

    @property
    def names(self) -> tuple[str, str]:
        """Names of its strands and of the rule for what is over them."""
        return f"the cable {self.force}", f"the cable {self.force}"

    def z(self, heights: Heights) -> float:
        """Return the height (rmm) of its middle."""
        return heights.bottom(self.layer) + heights.thickness / 2

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield its strands, which move in the world."""
        touches = frozenset([*(pulley.what for pulley in self.pulleys), *(stud.what for stud in self.studs(layout))])
        frame = f"cable {self.force}"
        layout.poses.setdefault(frame, np.zeros((len(layout.times), 3)))
        for span in self.spans:
            start, end = (layout.seen(m.body.name, layout.place(m), "ground") for m in (span.i, span.j))
            first, second = (layout.sizes.of_metres(radius) for radius in signed_radii(span.params))
            path = span_ends(start, end, (first, second))
            shape = Rounded(path, 2 * BELT)
            yield Item(self.names[0], frame, shape, Reach((self.layer,)), source=self, meshes=touches)

    def studs(self, layout: Layout) -> list[Stud]:
        """Return what holds its ends."""
        return [
            Stud(end.body.name, *layout.place(end), ((self, k),), None)  # pyright: ignore[reportArgumentType]
            for k, end in enumerate(self.ends)
        ]


@extent(SPANS)
@extent(SLACK_SPANS)
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Return its wheels."""
    wheels = (joint.i, joint.params["radius_i"]), (joint.j, joint.params["radius_j"])
    both = tuple((marker, radius) for marker, radius in wheels if radius > 0.0)
    return Extent(both, tuple((radius, LEAST) for _, radius in both))


def cables(m: Mechanism, layout: Layout) -> list[Cable]:
    """Return all cables of a mechanism with their pulleys. Raises UserError for one that has none."""
    kinds = (SPANS, SLACK_SPANS)
    spans = {
        span.name: seen_span(m, span) for span in (*m.joints.values(), *m.contacts.values()) if span.kind.name in kinds
    }
    rows = rows_of_spans({name: _wheels(span) for name, span in spans.items()})
    return [_cable(m, [spans[name] for name in row], layout) for row in rows]


def _wheels(span: Joint) -> tuple[_Wheel | None, _Wheel | None]:
    """Return the wheels of a span: body, place and signed radius (m); None for a point."""
    first, second = (
        (end.body.name, end.x, end.y, radius) if radius else None
        for end, radius in zip((span.i, span.j), signed_radii(span.params), strict=True)
    )
    return first, second


def _cable(m: Mechanism, spans: list[Joint], layout: Layout) -> Cable:
    stations = [(spans[0].i, signed_radii(spans[0].params)[0])]
    stations += [(span.j, signed_radii(span.params)[1]) for span in spans]
    pulleys: list[Pulley] = []
    for marker, radius in stations:
        if radius == 0.0:
            continue
        (x, y), size, body = layout.place(marker), layout.sizes.of_metres(abs(radius)), marker.body.name
        if any(p.body == body and math.hypot(p.x - x, p.y - y) < SAME and p.radius == size for p in pulleys):
            continue
        pulley = Pulley(f"{spans[0].name}_{body}", body, x, y, size, belt=spans[0].name)
        pulley.tip = pulley.lip
        pulleys.append(pulley)
    if not pulleys:
        raise UserError(
            f"{m.name}: cable '{spans[0].name}' has no wheel; write m.rope or m.distance between two points, or "
            f"{shown_file(m.name, 'parts')}"
        )
    for before, after in pairwise(pulleys):
        before.mates.append(after)
        after.mates.append(before)
    ends = [marker for marker, radius in (stations[0], stations[-1]) if radius == 0.0]
    return Cable(tuple(spans), tuple(pulleys), tuple(ends))
