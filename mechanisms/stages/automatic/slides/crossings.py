"""Slides on ground whose rails would cross, as of an elliptical trammel: a plate with grooves, and shuttles in them.

Each shuttle has a tongue below its plate, longer than a groove is wide, so that it is guided while it passes the other
groove. All shuttles of a plate share a layer, as their tongues must reach the grooves.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.items import BASE, Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.planar import Rounded, core_gaps, disc
from mechanisms.stages.automatic.slides.slides import HALF_LENGTH, RAIL

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.slides.slides import Slide

TONGUE, TONGUE_DEPTH = 11.0, 6.5
"""Width of a tongue, and how far it reaches down."""
TONGUE_HALF = 22.0
"""Half of its length: twice as long as the grooves that it passes are wide."""
FLOOR = 3.5
"""Thickness of the plate below its grooves, at least."""
WALL = 8.0
"""Width of the plate beside its grooves."""
CORE = 30.0
"""Radius of the plate about the crossing."""
SMALLEST = math.radians(30.0)
"""Grooves at a smaller angle would leave a tongue without a guide where they cross."""

type Ends = list[tuple[float, float]]


@dataclass(frozen=True, eq=False)
class Crossing:
    """Slides on ground in the grooves of one plate."""

    slides: tuple[Slide, ...]

    @property
    def name(self) -> str:
        """Names of its joints."""
        return "_".join(slide.name for slide in self.slides)

    @property
    def what(self) -> str:
        """Name of the plate."""
        return f"the grooved plate of {' and '.join(slide.name for slide in self.slides)}"

    @property
    def blocks(self) -> tuple[str, ...]:
        """The bodies of the shuttles."""
        return tuple(dict.fromkeys(slide.block for slide in self.slides))

    @property
    def middle(self) -> tuple[float, float]:
        """Where the grooves cross: of more than two the mean."""
        places = [_crossing(*pair) for pair in combinations(self.slides, 2)]
        x, y = np.mean([place for place in places if place is not None], axis=0)
        return float(x), float(y)

    def groove(self, slide: Slide) -> Ends:
        """Middles (rmm) of the round ends of a groove."""
        reach = TONGUE_HALF - TONGUE / 2
        return [slide.rail_place(slide.travel[0] - reach), slide.rail_place(slide.travel[1] + reach)]

    def tongue(self, slide: Slide) -> Ends:
        """Middles (rmm) of the round ends of a tongue, in the frame of its body."""
        reach = TONGUE_HALF - TONGUE / 2
        return [slide.block_place(-reach), slide.block_place(reach)]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """The plates of the shuttles; what the grooved plate is fixed by."""
        eye = layout.sizes.eye
        anchors = [Anchor(slide.block, x, y, eye) for slide in self.slides for x, y in slide.block_ends(eye)]
        return [*anchors, *(Anchor("ground", x, y, WALL) for slide in self.slides for x, y in self.groove(slide))]

    def items(self, layout: Layout) -> Iterable[Item]:
        """The plate below the shuttles, and their tongues in it."""
        tongues = {slide.name: f"the tongue of {slide.name}" for slide in self.slides}
        meshes, reach = frozenset(tongues.values()), Reach(self.blocks, -1, -1, base=True)
        for slide in self.slides:
            arm = Rounded(np.array(self.groove(slide)), TONGUE / 2 + WALL + 0.5)
            yield Item(self.what, "ground", arm, reach, source=self, meshes=meshes, stands=self.what)
            shape = Rounded(np.array(self.tongue(slide)), TONGUE / 2 + 0.5)
            below = Reach((slide.block,), -1, -1)
            yield Item(tongues[slide.name], slide.block, shape, below, source=self, meshes=frozenset((self.what,)))
        yield Item(self.what, "ground", disc(*self.middle, CORE), reach, source=self, meshes=meshes, stands=self.what)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for the plate."""
        if levels[self.blocks[0]] == 0:
            yield Need(BASE, FLOOR + TONGUE_DEPTH + 2 * layout.sizes.pivot.fit.axial)
        else:
            yield Need(levels[self.blocks[0]] - 1, TONGUE_DEPTH + 2 * layout.sizes.pivot.fit.axial)


def with_crossings(slides: Sequence[Slide], layout: Layout) -> list[Feature]:
    """The slides, those on ground that cross as one feature."""
    group = {slide.name: slide.name for slide in slides}
    for first, second in combinations([slide for slide in slides if slide.rail == "ground"], 2):
        if _crossing(first, second) is not None and group[first.name] != group[second.name]:
            old, new = group[second.name], group[first.name]
            group = {name: new if of == old else of for name, of in group.items()}
    features: list[Feature] = []
    for head in dict.fromkeys(group.values()):
        members = tuple(slide for slide in slides if group[slide.name] == head)
        if len(members) == 1:
            features += members
            continue
        crossing = Crossing(members)
        layout.together += [(crossing.blocks[0], block) for block in crossing.blocks[1:]]
        features.append(crossing)
    return features


def _crossing(first: Slide, second: Slide) -> np.ndarray | None:
    """(2,) where two rails would cross; None where they stay clear of each other, or are nearly parallel."""
    if first.block == second.block:
        return None
    (a, b), (c, d) = (np.array(slide.rail_ends()) for slide in (first, second))
    if core_gaps(np.array([[a, b]]), np.array([[c, d]]))[0] > RAIL + 2.0 + 2 * (HALF_LENGTH - TONGUE_HALF):
        return None
    u, v = (b - a) / np.hypot(*(b - a)), (d - c) / np.hypot(*(d - c))
    sine = u[0] * v[1] - u[1] * v[0]
    if abs(sine) < math.sin(SMALLEST):
        return None
    return a + u * ((c - a)[0] * v[1] - (c - a)[1] * v[0]) / sine
