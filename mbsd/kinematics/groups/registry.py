"""All kinds of groups, in the order of their codes (groups.py): for the plan and for tables.

A new kind is its file in kinds/, its code, a line here, and one in solve_group.py.
"""

from __future__ import annotations

from mbsd.kinematics.groups.kinds import driven, prp, rod, rpr, rrp, rrr, slide, welded, yoke

KINDS = (
    driven.KIND,
    welded.KIND,
    rrr.KIND,
    rrp.KIND,
    rpr.KIND,
    yoke.KIND,
    prp.KIND,
    rod.KIND,
    slide.KIND,
)
NAMES = tuple(kind.name for kind in KINDS)
BRANCH = {kind.code: kind.branch for kind in KINDS if kind.branch is not None}
"""Where the sign of the assembly stands."""
