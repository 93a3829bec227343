"""The features of a mechanism, from its joints, forces, contacts and drivers, and its layout."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import mechanisms.stages.automatic.kinds  # noqa: F401  (enters them)
from mbsd import Mechanism
from mbsd.model.cables import seen_span
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import hidden_bodies
from mechanisms.stages.automatic.body_shapes import Joined
from mechanisms.stages.automatic.layout.items import Anchor, Heights
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import CONTACT_KINDS, DRIVER_KINDS, FORCE_KINDS, KINDS, Plan
from mechanisms.stages.automatic.layout.sizes import ROD, Kinds
from mechanisms.stages.automatic.looks import shaped
from mechanisms.stages.automatic.pins.free_bodies import free_bodies, styluses, weights
from mechanisms.stages.automatic.pins.pins import add_poses
from mechanisms.stages.automatic.pins.stops import stops
from mechanisms.stages.automatic.pins.welds import with_free_bolts
from mechanisms.stages.automatic.rolling.roads import with_shared_roads
from mechanisms.stages.automatic.slides.slots import refuse_pins_of_both_kinds
from mechanisms.stages.automatic.wheels.gears import with_own_layers
from shared.shapes.link import Eye
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# The features of a mechanism: of its joints, forces, contacts and drivers by their kinds; eyes where a body is left
# out.

SHAPELESS = ("angle_lock", "constraint", "turn_ratio", "travel_ratio")
"""Kinds of joints that hold by no part of their own."""


@dataclass(frozen=True, eq=False)
class LooseEye(Feature):
    """Where a joint would hold a body that is left out: an eye of the other body, bored for a pin (rmm)."""

    body: str
    x: float
    y: float
    bored: bool

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return the eye."""
        return [Anchor(self.body, self.x, self.y, layout.sizes.eye)]

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build a bore; without one the plate goes round the place anyway."""
        if self.bored:
            sizes = plan.layout.sizes
            plan.eye(self.body, self.x, self.y, Eye(sizes.eye, sizes.pivot.running))


def gathered(layout: Layout) -> list[Feature]:
    """Return all features of joints, forces, contacts and drivers.

    Raises UserError for a kind of joint that has no parts.
    """
    m = layout.m
    by_kind: dict[str, list[Joint]] = {}
    loose: list[Joint] = []
    hidden = hidden_bodies(m)
    for name, joint in m.joints.items():
        kind = joint.kind.name
        joint = seen_span(m, joint) if "span" in joint.kind.constraints else joint
        if kind in SHAPELESS or hidden.intersection(joint.bodies):
            continue
        if layout.apart.intersection(joint.bodies) or (kind == ROD and joint not in layout.rods.values()):
            loose.append(joint)
        elif kind not in KINDS:
            raise UserError(
                f"{m.name}: joint '{name}' is a {kind.replace('_', ' ')}, which has no automatic "
                f"parts yet (there are: {', '.join(KINDS)}); leave one of its bodies out, or write "
                f"{shown_file(m.name, 'parts')}"
            )
        else:
            by_kind.setdefault(kind, []).append(joint)
    features = [feature for kind, joints in by_kind.items() for feature in KINDS[kind](m, joints, layout)]
    layout.features = list(features)  # springs look for pins that hold them
    features += _gather_kinds(FORCE_KINDS, m, m.forces.values(), layout)
    features += _gather_kinds(CONTACT_KINDS, m, m.contacts.values(), layout)
    features = with_shared_roads(features)
    features += _gather_kinds(DRIVER_KINDS, m, m.drivers.values(), layout)
    features += stops(m, features, layout)
    refuse_pins_of_both_kinds(m, features)
    features = with_free_bolts(features, layout)
    return features + _loose_eyes(loose, features, layout)


def _gather_kinds(
    kinds: Kinds[Sequence[Feature]], m: Mechanism, things: Iterable[Force | Joint], layout: Layout
) -> list[Feature]:
    """Return features of forces, contacts or drivers whose kinds have parts; the others need none."""
    by_kind: dict[str, list[Force | Joint]] = {}
    for thing in things:
        if thing.kind.name in kinds and not layout.apart.intersection(thing.bodies):
            by_kind.setdefault(thing.kind.name, []).append(thing)
    return [feature for kind, same in by_kind.items() for feature in kinds[kind](m, same, layout)]


def _loose_eyes(joints: list[Joint], features: list[Feature], layout: Layout) -> list[Feature]:
    """Return an eye for each place of a joint on a moving body whose other body is left out.

    None where something is there already.
    """
    taken = [anchor for feature in features for anchor in feature.anchors(layout)]
    eyes: list[LooseEye] = []
    for joint in joints:
        for marker in (joint.i, joint.j):
            body, (x, y) = marker.body.name, layout.place(marker)
            beside = [*(a for a in taken if a.body == body), *(eye for eye in eyes if eye.body == body)]
            free = all(abs(other.x - x) > 0.02 or abs(other.y - y) > 0.02 for other in beside)
            if body in layout.moving and free:
                eyes.append(LooseEye(body, x, y, joint.kind.pair == "pin" or joint.kind.name == ROD))
    return list(eyes)


# A layout with its features: those of joints and forces, then what free bodies, weights and traced points show.


def laid_out(
    layout: Layout, joined: Sequence[Joined], tubes: bool, tall: bool, pointers: bool, looks: bool = False
) -> Layout:
    """Return the layout with all that takes room in it. Raises UserError for what has no part.

    ``joined``: pieces that the author added; ``tubes``: wheels stand on tubes; ``tall``: with styluses that stand up,
    not flush ones; ``pointers``: with those of points on rims; ``looks``: bodies look like what their names say.
    """
    add_poses(layout)
    layout.features = gathered(layout)
    layout.features += free_bodies(layout)
    layout.features += weights(layout, heavy=True)
    layout.features += styluses(layout, tall, pointers)
    layout.features += weights(layout, heavy=False)
    layout.features += shaped(layout, [own.body for own in joined]) if looks else []
    layout.features += joined
    return with_own_layers(layout, tubes)
