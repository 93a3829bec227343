"""The groups that are solved in closed form, as tables; arms are from centres of mass, in body axes (m).

    DRIVEN   body A pinned to K1, its angle given against K2 by a driver
        P on K1, P on A, offset, sense
    WELDED   body A fixed to K1
        P on K1, P on A, angle of A against K1
    RRR      A pinned to K1 at P, B pinned to K2 at Q, A pinned to B at C
        P on K1, P on A, C on A, Q on K2, Q on B, C on B, branch
    RRP      A pinned to K1 at P and at C to B, which slides on K2; or C of A runs in a slot of K2 (B: -1)
        P on K1, P on A, C on A, C on K2 where the slide is at 0, axis on K2, angle of B against K2, C on B, branch
    RPR      A pinned to K1 at P, B pinned to K2 at Q, B slides on A; or point Q of K2 runs in a slot of A (B: -1)
        P on K1, P on A, axis on A, offset of Q from it, Q on K2, angle of B against A, Q on B, branch
    YOKE     A slides on K1, point Q of K2 runs in a slot of A
        slot point on K1 where the slide is at 0, slide axis on K1, slot normal on K1, Q on K2, angle of A against K1,
        slot point on A
    PRP   A slides on K1 and is pinned at C to B, which slides on K2; or C of A runs in a slot of K2 (B: -1)
        C on K1 where the slide is at 0, axis on K1, angle of A against K1, C on A, and the same five of K2 and B
    ROD   A pinned to K1 at P, a rod or actuator holds the distance from C of A to Q of K2
        P on K1, P on A, C on A, Q on K2, length (beside the law's), branch
    SLIDE A slides on K1 as far as a driver says
        point on K1 where the law is at 0, its way on K1 for each unit of the law, angle of A against K1, point on A

Source: Assur 1914; Norton, Design of Machinery, ch. 4, 6, 7 (loop closure of dyads).
"""

from __future__ import annotations

from typing import Any, NamedTuple

DRIVEN, WELDED, RRR, RRP, RPR, YOKE, PRP, ROD, SLIDE = range(9)
NAMES = ("driven", "welded", "RRR", "RRP", "RPR", "yoke", "PRP", "rod", "driven slide")
NUMBERS = 14
BRANCH = {RRR: 12, RRP: 13, RPR: 12, ROD: 9}
"""Where the sign of the assembly stands."""


class Groups(NamedTuple):
    """Groups in the order of their solution."""

    kind: Any
    """(g,)"""
    body: Any
    """(g, 4) A, B or -1, K1, K2."""
    motion: Any
    """(g,) law of DRIVEN and SLIDE groups and of actuators, else 0."""
    number: Any
    """(g, 14) as listed above."""
