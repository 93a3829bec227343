"""One group of any kind: the place where a kind's number becomes its kernel."""

from __future__ import annotations

from mbsd.compiling.jit import merged
from mbsd.kinematics.groups.groups import DRIVEN, KIND, PRP, ROD, RPR, RRP, RRR, WELDED, YOKE
from mbsd.kinematics.groups.kinds.driven import solve_driven
from mbsd.kinematics.groups.kinds.prp import solve_prp
from mbsd.kinematics.groups.kinds.rod import solve_rod
from mbsd.kinematics.groups.kinds.rpr import solve_rpr
from mbsd.kinematics.groups.kinds.rrp import solve_rrp
from mbsd.kinematics.groups.kinds.rrr import solve_rrr
from mbsd.kinematics.groups.kinds.slide import solve_slide
from mbsd.kinematics.groups.kinds.welded import solve_welded
from mbsd.kinematics.groups.kinds.yoke import solve_yoke


@merged
def solve_group(case, e):
    """Place the bodies of group e and fill their rates; see kinds/prp.py. Returns SOLVED, or why not."""
    kind = case.group[e, KIND]
    if kind == RRR:
        return solve_rrr(case, e)
    if kind == DRIVEN:
        return solve_driven(case, e)
    if kind == WELDED:
        return solve_welded(case, e)
    if kind == RRP:
        return solve_rrp(case, e)
    if kind == RPR:
        return solve_rpr(case, e)
    if kind == YOKE:
        return solve_yoke(case, e)
    if kind == PRP:
        return solve_prp(case, e)
    if kind == ROD:
        return solve_rod(case, e)
    return solve_slide(case, e)
