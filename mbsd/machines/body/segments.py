"""Masses, centres and radii of gyration of the segments of a human body, from published tables.

Every number is a fraction: of the body's mass, of a reference length, and that length of the body's height. A mass is
that of one side. Centres are measured from the proximal end; radii of gyration are about the centre of mass and an axis
across the sagittal plane, in which the body is seen from its side.

Sources: D. A. Winter, Biomechanics and Motor Control of Human Movement, table 4.1 (after Dempster, 1955); P. de Leva,
J. Biomech. 29 (1996) 1223, table 4 (after Zatsiorsky and Seluyanov); lengths R. Drillis, R. Contini, Body Segment
Parameters, New York University, 1966. The numbers of both tables are those of the files BSP_DempsterWinter.txt,
BSPmale_ZdeLeva.txt and BSPfemale_ZdeLeva.txt of M. Duarte's notes, github.com/BMClab/BMC.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

LENGTHS: Mapping[str, float] = {
    "ankle": 0.039,
    "foot": 0.152,
    "shank": 0.246,
    "thigh": 0.245,
    "trunk": 0.288,
    "upper_arm": 0.186,
    "forearm": 0.146,
    "hand": 0.108,
}
"""Fractions of the height: ankle above the sole, length of the foot, joint to joint; trunk from hip to shoulder."""

HEEL, BALL = 0.25, 0.48
"""Assumed: heel behind and ball of the foot in front of the ankle, of the foot's length. The foot stands still, so that
they say no more than where its weight is."""


@dataclass(frozen=True)
class Segment:
    """A rigid segment, or several that are taken for one."""

    mass: float
    """Fraction of the body's mass."""
    com: float
    """Centre of mass from the proximal end, of ``length``."""
    gyration: float
    """Radius about the centre of mass, of ``length``."""
    length: float
    """Reference length, of the height."""
    start: float = 0.0
    """Proximal end beyond the joint of the limb it belongs to, of the height."""

    @property
    def from_distal(self) -> float:
        """Centre of mass from the distal end, of ``length``."""
        return round(1.0 - self.com, 12)


@dataclass(frozen=True)
class SegmentTable:
    """The segments of a body by limb.

    Those of one limb lie along one line and do not move against each other.
    """

    name: str
    foot: Segment
    """Length from the ankle to the ball of the foot (Winter), or from heel to toe (de Leva)."""
    from_heel: bool
    """True if the foot's reference line is that from heel to toe."""
    shank: tuple[Segment, ...]
    thigh: tuple[Segment, ...]
    trunk: tuple[Segment, ...]
    """With neck and head; from the hip on."""
    upper_arm: tuple[Segment, ...]
    forearm: tuple[Segment, ...]
    """With the hand."""

    @property
    def total(self) -> float:
        """All masses together, of the body's: 1 but for the rounding of the table."""
        sides = (self.foot, *self.shank, *self.thigh, *self.upper_arm, *self.forearm)
        return sum(segment.mass for segment in self.trunk) + 2 * sum(segment.mass for segment in sides)


_ANKLE_TO_BALL = (LENGTHS["ankle"] ** 2 + (BALL * LENGTHS["foot"]) ** 2) ** 0.5

WINTER = SegmentTable(
    name="Winter",
    foot=Segment(0.0145, 0.500, 0.475, _ANKLE_TO_BALL),
    from_heel=False,
    shank=(Segment(0.0465, 0.433, 0.302, LENGTHS["shank"]),),
    thigh=(Segment(0.100, 0.433, 0.323, LENGTHS["thigh"]),),
    trunk=(Segment(0.578, 0.660, 0.503, LENGTHS["trunk"]),),
    upper_arm=(Segment(0.028, 0.436, 0.322, LENGTHS["upper_arm"]),),
    forearm=(Segment(0.022, 0.682, 0.468, LENGTHS["forearm"]),),
)
"""Trunk, neck and head are one segment, forearm and hand another."""

FOOT_AND_LEG = Segment(0.061, 0.606, 0.416, LENGTHS["shank"] + LENGTHS["ankle"])
"""Winter's foot and leg as one segment, from the knee to the medial malleolus."""

ARMS_HEAD_TRUNK = Segment(0.678, 0.626, 0.496, LENGTHS["trunk"])
"""Winter's head, arms and trunk as one segment, the arms hanging, from the hip to the shoulder."""

# De Leva's lengths of the head, of the height: from the vertex to the seventh cervical vertebra.
_HEAD_OF_MEN, _HEAD_OF_WOMEN = 0.2429 / 1.741, 0.2437 / 1.735
_TO_METACARPAL = 0.0495
_HIP = 0.530
"""Height of the hip, of the height (Drillis and Contini)."""

DE_LEVA_MEN = SegmentTable(
    name="de Leva, men",
    foot=Segment(0.0137, 0.4415, 0.245, LENGTHS["foot"]),
    from_heel=True,
    shank=(Segment(0.0433, 0.4395, 0.246, LENGTHS["shank"]),),
    thigh=(Segment(0.1416, 0.4095, 0.329, LENGTHS["thigh"]),),
    trunk=(
        Segment(0.4346, 1.0 - 0.4310, 0.358, LENGTHS["trunk"]),
        Segment(0.0694, 1.0 - 0.5002, 0.315, _HEAD_OF_MEN, start=1.0 - _HEAD_OF_MEN - _HIP),
    ),
    upper_arm=(Segment(0.0271, 0.5772, 0.269, LENGTHS["upper_arm"]),),
    forearm=(
        Segment(0.0162, 0.4574, 0.265, LENGTHS["forearm"]),
        Segment(0.0061, 0.7900, 0.513, _TO_METACARPAL, start=LENGTHS["forearm"]),
    ),
)
"""Trunk from mid-hip to mid-shoulder, head from the seventh cervical vertebra to the vertex."""

DE_LEVA_WOMEN = SegmentTable(
    name="de Leva, women",
    foot=Segment(0.0129, 0.4014, 0.279, LENGTHS["foot"]),
    from_heel=True,
    shank=(Segment(0.0481, 0.4352, 0.263, LENGTHS["shank"]),),
    thigh=(Segment(0.1478, 0.3612, 0.364, LENGTHS["thigh"]),),
    trunk=(
        Segment(0.4257, 1.0 - 0.3782, 0.361, LENGTHS["trunk"]),
        Segment(0.0668, 1.0 - 0.4841, 0.295, _HEAD_OF_WOMEN, start=1.0 - _HEAD_OF_WOMEN - _HIP),
    ),
    upper_arm=(Segment(0.0255, 0.5754, 0.260, LENGTHS["upper_arm"]),),
    forearm=(
        Segment(0.0138, 0.4559, 0.257, LENGTHS["forearm"]),
        Segment(0.0056, 0.7474, 0.454, _TO_METACARPAL, start=LENGTHS["forearm"]),
    ),
)
"""Table like :data:`DE_LEVA_MEN`."""

TABLES: tuple[SegmentTable, ...] = (WINTER, DE_LEVA_MEN, DE_LEVA_WOMEN)
