"""Bevel wheels in space: their cones from the axes of a gear pair, and their teeth (Tredgold).

Teeth are those of a spur wheel on the back cone, drawn towards the apex in which both axes meet:

    tan(cone) = sin(angle of axes) z / (z_other + z cos(angle of axes)),   teeth on the back cone: z / cos(cone)

Spur wheels, worms and skew pairs have no teeth in space yet; their bodies turn without.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.couplings import common_carrier, moved_marker
from mbsd.spatial.model.joint import Joint
from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.moves import MM, Array, Moves, Sizes
from mechanisms.stages.automatic.space.pieces import End
from mechanisms.stages.automatic.space.round import across
from mechanisms.stages.automatic.space.wheels import disc_half, is_wheel
from shared.shapes.involute import DEDENDUM, toothed
from shared.stage.errors import UserError

FACE = 0.3
"""Width of teeth along the cone, in lengths of the cone."""
PLAY = 0.06
"""Taken from the thickness of teeth, in modules."""


@dataclass
class BevelWheel:
    """Wheel of a bevel pair, in the frame of its body (mm)."""

    marker: Marker
    apex: Array
    axis: Array
    """Unit vector from the apex to the wheel."""
    teeth: int
    cone: float
    """Half of the angle of its pitch cone (rad)."""
    contact: Array
    """Unit vector normal to the axis, to where it meets its mate in the design pose."""
    along: Array
    """Unit vector in which teeth pass there."""
    length: float = 0.0
    """Length of the pitch cone."""
    tooth: float | None = None
    """Angle of a tooth about the axis, from the contact (rad)."""

    @property
    def sense(self) -> float:
        """1 if angles about the axis rise along the direction in which teeth pass, else -1."""
        return float(np.sign(np.cross(self.axis, self.contact) @ self.along))

    def end(self, sizes: Sizes) -> End:
        """Return the toothed wheel and its hub as an end of its body; a disc is bored, a shaft goes on behind."""
        large, small = (part * self.length * math.cos(self.cone) for part in (1.0, 1.0 - FACE))
        solids = [self._toothed(small, large)]
        hub = 0.55 * large * math.tan(self.cone)
        if not is_wheel(self.marker):
            back = self.apex + (large + 0.3 * sizes.rod) * self.axis
            solids.append(shapes.rod(self.apex + small * self.axis, back, hub))
            return End(f"teeth_{self.marker.body.name}", self.apex + large * self.axis, solids)
        solids.append(shapes.rod(self.apex + small * self.axis, np.zeros(3), hub))
        bore = shapes.rod(self.apex + (small - 1.0) * self.axis, np.zeros(3), sizes.pin + sizes.play)
        return End(f"teeth_{self.marker.body.name}", np.zeros(3), solids, [bore])

    def front(self) -> float:
        """Return how far its front stands from the middle of its disc (mm)."""
        return float((np.zeros(3) - self.apex) @ self.axis) - (1.0 - FACE) * self.length * math.cos(self.cone)

    def _toothed(self, small: float, large: float) -> cq.Shape:
        """Return the teeth, cut by a plane where their tips meet the back cone."""
        radius = self.length * math.sin(self.cone)
        module, back = 2.0 * radius / self.teeth, radius / math.cos(self.cone)
        count = round(self.teeth / math.cos(self.cone))
        play = PLAY * module + math.pi * (back / count - module / 2)
        outline = toothed(count, 2.0 * back / count, back + module, back - DEDENDUM * module, play)
        own = outline[: len(outline) // count]
        polar = self.cone + np.arctan((np.hypot(*own.T) - back) / self.length)
        turn = np.arctan2(own[:, 1], own[:, 0]) / math.cos(self.cone)
        turns = ((self.tooth or 0.0) + 2.0 * math.pi * np.arange(self.teeth)[:, None] / self.teeth + turn).ravel()
        end = large / math.cos(self.cone) ** 2 / (1.0 + math.tan(self.cone) * math.tan(polar.max()))
        spread = np.tile(np.tan(polar), self.teeth)
        side = np.cross(self.axis, self.contact)
        rays = self.axis + spread[:, None] * (np.outer(np.cos(turns), self.contact) + np.outer(np.sin(turns), side))
        wires = [
            cq.Wire.makePolygon([cq.Vector(*(self.apex + height * ray)) for ray in rays], close=True)
            for height in (small, end)
        ]
        return cq.Solid.makeLoft(wires, True)


def bevel_wheels(moves: Moves) -> dict[str, BevelWheel]:
    """Return the wheels of all bevel pairs by body. Raises UserError where teeth of a wheel cannot meet two mates."""
    wheels: dict[str, BevelWheel] = {}
    for joint in moves.m.joints.values():
        pair = _pair(moves, joint) if joint.kind.name == "gear_pair" else None
        if pair is None:
            continue
        own = [wheels.setdefault(wheel.marker.body.name, wheel) for wheel in pair]
        _phase(moves, joint, own, pair)
    lengths = [_room(wheel, moves.sizes) for wheel in wheels.values()]
    for wheel in wheels.values():
        wheel.length = min(lengths)
    return wheels


def _pair(moves: Moves, joint: Joint) -> list[BevelWheel] | None:
    """Return both wheels of a pair whose axes meet; None of any other."""
    carrier = common_carrier(joint.name, joint.coupled)
    markers = [moved_marker(part, carrier) for part in joint.coupled]
    places = [MM * marker.world_place for marker in markers]
    axes = [marker.body.rotation @ np.array(marker.axis) for marker in markers]
    normal = np.cross(axes[0], axes[1])
    if np.linalg.norm(normal) < 1e-6 or abs((places[1] - places[0]) @ normal) > 1e-6 * moves.sizes.rod:
        return None
    part = np.linalg.lstsq(np.column_stack([axes[0], -axes[1]]), places[1] - places[0], rcond=None)[0]
    apex = places[0] + part[0] * axes[0]
    ways = [float(np.sign((place - apex) @ axis)) * axis for place, axis in zip(places, axes, strict=True)]
    if not all(way.any() for way in ways):
        return None
    angle = math.acos(float(np.clip(ways[0] @ ways[1], -1.0, 1.0)))
    out = []
    for k, (marker, teeth) in enumerate(zip(markers, joint.params["teeth"], strict=True)):
        other = joint.params["teeth"][1 - k]
        cone = math.atan2(math.sin(angle) * teeth, other + teeth * math.cos(angle))
        back = marker.body.rotation.T
        own = back @ (apex - MM * np.array(marker.body.place))
        contact = back @ across(ways[k], ways[1 - k])
        out.append(BevelWheel(marker, own, back @ ways[k], teeth, cone, contact, back @ np.cross(ways[0], ways[1])))
    return out


def _phase(moves: Moves, joint: Joint, own: list[BevelWheel], pair: list[BevelWheel]) -> None:
    """Turn teeth so that one of the first wheel stands in a gap of the second."""
    first, second = own
    if first.tooth is None and second.tooth is None:
        first.tooth = 0.0
    shares: list[float | None] = []
    for wheel, here in zip(own, pair, strict=True):
        if wheel.tooth is None:
            shares.append(None)
            continue
        met = math.atan2(here.contact @ np.cross(wheel.axis, wheel.contact), here.contact @ wheel.contact)
        shares.append(here.sense * (wheel.tooth - met) * wheel.teeth / (2.0 * math.pi))
    if shares[0] is None or shares[1] is None:
        late, known = (1, shares[0]) if shares[1] is None else (0, shares[1])
        own[late].tooth = pair[late].sense * ((known or 0.0) + 0.5) * 2.0 * math.pi / own[late].teeth
    elif abs((shares[0] - shares[1]) % 1.0 - 0.5) > 0.02:
        raise UserError(
            f"{moves.m.name}: teeth of '{joint.name}' meet other wheels already and do not fit each other; change a "
            "number of teeth, or write a parts.py"
        )


def _room(wheel: BevelWheel, sizes: Sizes) -> float:
    """Return the longest pitch cone before the joint or disc behind a wheel (mm)."""
    far = float((MM * np.array(wheel.marker.place) - wheel.apex) @ wheel.axis)
    behind = disc_half(wheel.marker.body, sizes) if is_wheel(wheel.marker) else 1.3 * sizes.block + 1.5 * sizes.rod
    return (far - behind - 0.4 * sizes.rod) / math.cos(wheel.cone)
