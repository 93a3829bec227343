"""Contacts of outlines: bodies of any shape that push each other where they touch.

    g = gap of the nearest pair        constraint `outline`;            see mbsd/equations/relative/outline_features.py
    s = way that they slide there      constraint `outline_sliding`

Wherever two bodies touch, a convex part of one of them does: a corner, an arc or a row of arcs, called a run. So a
contact of two outlines is some rows, each of runs of one outline on the other one:

    runs of a    on lines, concave and convex arcs of b
    runs of b    on lines and concave arcs of a, as their arcs on arcs of a are in the rows above

Runs that are farther apart than the other body reaches never touch it together and share a row, such as the tips of a
wheel on a pallet. Where the other outline is not convex, a run may touch it at two places at once, and has a second row
for the second place. Each row is a contact like the others: it closes with an impact, rests, slides, sticks and opens.

By penalty the pairs of all rows push, each by the law of `contact` (mbsd/model/forces/contact.py), with d = -g.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from mbsd.base.arguments import whole_number
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.body import Body, Marker
from mbsd.model.entries import add_contact, frictions_given
from mbsd.model.joint import ContactKind, Joint, register_contact
from mbsd.model.mechanism import Model, connections, new_name
from mbsd.model.outlines.features import CONCAVE, LINE, features_of, groups_of, is_convex, reach_of, runs_of, table_of
from mbsd.model.outlines.geometry import Corner, signed_area
from mbsd.model.outlines.outline import Outline, checked_corners, circle

MOST_RUNS = 4000
"""Features of an outline, and runs, at most: their numbers are codes in one float."""


def tuples_of(points: Sequence[Sequence[float]]) -> tuple[Corner, ...]:
    """Return corners that a file or a user gives as lists."""
    return tuple((float(x), float(y), float(bulge)) for x, y, bulge in points)


def _touch_numbers(params: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    both = tuples_of(params["outline_i"]), tuples_of(params["outline_j"])
    table = table_of(*both, tuple(int(run) for run in params["runs"]), params["second"], params["arcs"])
    return table, table


OUTLINE_TOUCH = register_contact(
    ContactKind(
        "outline_touch",
        ("outline", "outline_sliding"),
        example=lambda m, i, j: m.outline_touch(
            "example", i, j, circle(30.0, (-31.0, 0.0)), circle(0.5, (0.1, 0.2)), [0]
        ),
        numbers=_touch_numbers,
        lengths=("outline_i", "outline_j"),
        touching="place",
    )
)
"""The circle of the example is so large that one place of it faces the other wherever the test puts it."""


@OUTLINE_TOUCH.adds
def outline_touch(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    outline_i: Sequence[Sequence[float]],
    outline_j: Sequence[Sequence[float]],
    runs: Sequence[int],
    second: bool = False,
    arcs: bool = True,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> Joint:
    """Add a row of :func:`outline_contact`: ``runs`` of outline j touch outline i.

    Outlines are corners (x, y, bulge) in the axes of their markers (m). ``second``: the place beside the nearest one.
    ``arcs``: convex arcs of outline i are touched, too, and not its lines and concave arcs alone.
    """
    what = f"{m.name}: contact '{name}'"
    both = [plain_outline(f"{what}: outline_{key}", corners) for key, corners in (("i", outline_i), ("j", outline_j))]
    known = len(runs_of(tuples_of(both[1])))
    given = runs if isinstance(runs, Sequence) else [runs]
    chosen = [whole_number(f"{what}: runs[{k}]", run, 0) for k, run in enumerate(given)]
    if not chosen or max(chosen) >= known:
        raise ModelError(f"{what}: runs are {shown(runs)}; outline j has runs 0 to {known - 1}")
    params: dict[str, Any] = {"outline_i": both[0], "outline_j": both[1], "runs": chosen}
    params |= {"second": bool(second), "arcs": bool(arcs)}
    params |= frictions_given(m, name, friction, static_friction)
    return add_contact(m, OUTLINE_TOUCH, name, i, j, restitution, params)


def plain_outline(what: str, corners: Any) -> list[list[float]]:
    """Return corners as plain data, in their order. Raises ModelError for what is no outline."""
    try:
        hole = signed_area(tuples_of(corners)) < 0.0
    except (TypeError, ValueError, IndexError):
        hole = False
    return [list(corner) for corner in checked_corners(what, corners, hole, None)]


def outline_contact(
    m: Model,
    name: str,
    a: Outline | Body | str,
    b: Outline | Body | str,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> tuple[Joint, ...]:
    """Let outlines of two bodies touch rigidly, and return the rows ``name 1``, ``name 2`` and so on.

    ``a`` and ``b``: outlines, or bodies with all of theirs, or names of either. Their impacts, resting, sliding and
    sticking are those of the other rigid contacts; ``restitution`` (0 to 1) and ``friction`` as there. Raises
    ModelError for outlines of one body, or bodies without any.

        m.outline(wheel, "ratchet.dxf")
        m.outline(pawl, [(0, 0), (0.02, -0.003), (0.02, 0.003)])
        m.outline_contact("click", wheel, pawl, friction=0.1)
    """
    rows = list(_rows(m, f"contact '{name}'", a, b))
    names = [name] if len(rows) == 1 else [f"{name} {k}" for k in range(1, len(rows) + 1)]
    for each in names:
        new_name(m, each, "contact", *connections(m))
    return tuple(
        outline_touch(
            m, each, i.body.at(0.0, 0.0), j.body.at(0.0, 0.0), i.corners, j.corners, runs, second, arcs,
            restitution, friction, static_friction,
        )
        for each, (i, j, runs, second, arcs) in zip(names, rows, strict=True)
    )  # fmt: skip


Row = tuple[Outline, Outline, list[int], bool, bool]


def _rows(m: Model, what: str, a: Outline | Body | str, b: Outline | Body | str) -> Iterator[Row]:
    """Yield outlines, runs and switches of each row of two things. Raises ModelError."""
    pairs = [(first, other) for first in outlines_given(m, what, a) for other in outlines_given(m, what, b)]
    check_two_bodies(m, what, pairs)
    for first, other in pairs:
        yield from _rows_of(other, first, True)
        if any(feature.kind in (LINE, CONCAVE) for feature in features_of(first.corners)):
            yield from _rows_of(first, other, False)


def check_two_bodies(m: Model, what: str, pairs: Sequence[tuple[Outline, Outline]]) -> None:
    """Raise ModelError for two outlines of one body."""
    for first, other in pairs:
        if first.body is other.body:
            raise ModelError(
                f"{m.name}: {what}: outlines '{first.name}' and '{other.name}' are both of '{first.body.name}', which "
                "does not touch itself; name two bodies"
            )


def _rows_of(i: Outline, j: Outline, arcs: bool) -> Iterator[Row]:
    """Yield the rows of the runs of outline j on outline i."""
    for runs in groups_of(j.corners, reach_of(i.corners)):
        for again in (False,) if is_convex(i.corners) else (False, True):
            yield i, j, runs, again, arcs


def outlines_given(m: Model, what: str, given: Outline | Body | str) -> list[Outline]:
    """Return outlines, given by themselves, or by their body, or by name. Raises ModelError."""
    if isinstance(given, Outline):
        if m.outlines.get(given.name) is not given:
            raise ModelError(f"{m.name}: {what}: outline '{given.name}' is of another mechanism; add it with m.outline")
        outlines = [given]
    elif isinstance(given, str) and given in m.outlines and given not in m.bodies:
        outlines = [m.outlines[given]]
    else:
        name = given.name if isinstance(given, Body) else given
        if not isinstance(name, str) or name not in m.bodies:
            raise ModelError(f"{m.name}: {what}: {no_such('body or outline', name, [*m.bodies, *m.outlines])}")
        outlines = [outline for outline in m.outlines.values() if outline.body.name == name]
        if not outlines:
            raise ModelError(
                f"{m.name}: {what}: '{name}' has no outline; give it one: m.outline({name}, [(x, y), ...])"
            )
    for outline in outlines:
        count = len(features_of(outline.corners))
        if count >= MOST_RUNS:
            raise ModelError(
                f"{m.name}: {what}: outline '{outline.name}' has {count} lines, arcs and corners; {MOST_RUNS} are the "
                "most. Give fewer points, or a larger tolerance= of its splines"
            )
    return outlines
