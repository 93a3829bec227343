"""Rules of the layout of automatic parts, checked anew."""

from __future__ import annotations

import numpy as np

from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.items import span, spans_meet
from mechanisms.stages.automatic.layout.planar import core_gaps, placed


def meets(made: Automatic) -> list[str]:
    """Pairs of items at one height that come nearer than none: seen anew at some poses, without circles or coarse
    looks.
    """
    layout, meetings = made.layout, []
    at = np.linspace(0, len(layout.times) - 1, 60).astype(int)
    spans = [span(item.reach, made.decided) for item in layout.items]
    seen = [placed(item.shape.core_at(at), layout.poses[item.body][at]) for item in layout.items]
    for j, second in enumerate(layout.items):
        for i, first in enumerate(layout.items[:j]):
            by_design = first.body == second.body
            by_design = by_design or (first.spared and first.body in second.spares)
            by_design = by_design or (second.spared and second.body in first.spares)
            by_design = by_design or first.what in second.meshes or second.what in first.meshes
            if by_design or first.only or second.only or not spans_meet(spans[i], spans[j]):
                continue
            if (core_gaps(seen[i], seen[j]) < first.shape.radius + second.shape.radius).any():
                meetings.append(f"{first.what} meets {second.what}")
    return meetings
