"""Pictures know no kinds of joints, forces and contacts: where these act and how they look is in data.json."""

from __future__ import annotations

import ast
import re
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from matplotlib.figure import Figure

from mbsd import Mechanism, constant_rate
from mbsd.drawing.animation.arrows import reaction_arrows
from mbsd.model.entries import join
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import CONTACT_KINDS, KINDS, JointKind
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.stages.solve.skeleton_file import moving_of
from render.film.vectors import torques, vectors
from render.insights.loops import loops
from render.magnitudes import crank_of
from render.plots import plots_of
from render.plots.figures import WHOLE
from render.view.payload import payload
from shared.contract import Motion
from shared.contract.shot import Quantity
from shared.stage.errors import UserError

RENDER = Path(__file__).parents[2] / "render"
SHOWN: tuple[Quantity, ...] = ("velocities", "accelerations", "forces", "reactions")
NAMES = {name.removeprefix("drive_") for name in (*KINDS, *FORCE_KINDS, *CONTACT_KINDS)}


def test_no_file_of_render_asks_for_the_kind_of_a_joint_force_or_contact() -> None:
    for path in RENDER.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if not isinstance(node, ast.Compare):
                continue
            sides = [node.left, *node.comparators]
            asks = any(isinstance(side, ast.Attribute) and side.attr == "kind" for side in sides)
            words = {leaf.value for side in sides for leaf in ast.walk(side) if isinstance(leaf, ast.Constant)}
            assert not (asks and any(word in NAMES for word in words)), f"{path}:{node.lineno}"
            assert not (asks and any(isinstance(side, ast.Name) and side.id.isupper() for side in sides)), (
                f"{path}:{node.lineno} compares a kind with a list"
            )
            assert not any(
                isinstance(side, ast.Attribute) and side.attr == "kind" and isinstance(op, ast.In | ast.NotIn)
                for op, side in zip(node.ops, node.comparators, strict=True)
            ), f"{path}:{node.lineno} looks for a word in a kind"
    asked = re.compile(r"kind\s*(?:===?|!==?)\s*[\"'](\w+)[\"']")
    for path in RENDER.rglob("*.js"):
        assert not NAMES & (set(asked.findall(path.read_text())) - {"force", "contact"}), path  # these two are things


def four_bar(pin: JointKind) -> Mechanism:
    """A four-bar whose pins are of this kind."""
    m = Mechanism("four_bar", gravity=(0.0, -9.81))
    crank, coupler, rocker = (m.bar(n, length, mass=0.1) for n, length in (("a", 0.04), ("b", 0.12), ("c", 0.09)))
    join(m, pin, "A", m.ground.at(0.0, 0.0), crank.start, None)
    join(m, pin, "B", crank.end, coupler.start, None)
    join(m, pin, "C", coupler.end, rocker.end, None)
    join(m, pin, "D", m.ground.at(0.12, 0.0), rocker.start, None)
    m.drive_angle("motor", crank, constant_rate(6.0))
    m.trace("P", coupler.at(0.06, 0.03))
    m.start_near(c=90)
    return m


def test_a_kind_that_nobody_knows_is_drawn_and_reported_as_what_it_says_it_is() -> None:
    known, hinge = KINDS["revolute"], replace(KINDS["revolute"], name="hinge", sign="revolute")
    motions: list[Motion] = []
    pages = []
    for kind in (known, hinge):
        solution = four_bar(kind).sweep(steps=24)
        motions.append(to_motion(solution, None, "key", {}))
        pages.append(payload(motions[-1], moving_of(solution)))
    was, new = motions
    assert {joint.kind for joint in new.joints.values()} == {"hinge"}
    for made in (vectors, torques):
        for before, after in zip(made(was, SHOWN), made(new, SHOWN), strict=True):
            assert before.name == after.name
            assert np.array_equal(before.place, after.place)
            assert np.array_equal(before.value, after.value)
    assert crank_of(new) is not None
    assert [loop.follower for loop in loops(new)] == [loop.follower for loop in loops(was)] == ["c"]
    for page in pages:
        for joint in page["joints"].values():
            del joint["kind"]
    assert msgspec.json.encode(pages[0], enc_hook=np.ndarray.tolist) == msgspec.json.encode(
        pages[1], enc_hook=np.ndarray.tolist
    )


def test_a_kind_that_nobody_knows_is_drawn_animated_and_plotted() -> None:
    known, hinge = KINDS["revolute"], replace(KINDS["revolute"], name="hinge", sign="revolute")
    arrows, strokes, plots = [], [], []
    for kind in (known, hinge):
        solution = four_bar(kind).sweep(steps=24)
        arrows.append(reaction_arrows(solution))
        strokes.append(moving_of(solution).strokes)
        motion = to_motion(solution, None, "key", {})
        figures = {plot: WHOLE[plot](motion) for plot in ("reactions", "hodographs")}
        plots.append((plots_of(motion), [_curves(made) for made in figures.values()]))
    assert len(arrows[0]) == len(arrows[1]) > 0
    assert all(np.array_equal(was.place, new.place) for was, new in zip(*arrows, strict=True))
    assert strokes[0] == strokes[1]
    assert plots[0] == plots[1]
    assert all(plots[0][1])


def _curves(made: Figure) -> list[list[float]]:
    return [np.asarray(line.get_ydata(), float).tolist() for axes in made.axes for line in axes.lines]


def test_automatic_parts_refuse_a_kind_that_they_do_not_know_by_its_name() -> None:
    m = four_bar(replace(KINDS["revolute"], name="hinge", sign="revolute"))
    with pytest.raises(UserError, match="four_bar: joint 'A' is a hinge, which has no automatic parts yet"):
        Automatic(m, m.sweep(steps=24)).layout  # noqa: B018


@pytest.mark.parametrize(
    ("kinds", "pages"),
    [("joints", ("joints", "cams")), ("forces", ("forces",)), ("contacts", ("events",))],
)
def test_the_pages_of_docs_list_every_kind(kinds: str, pages: tuple[str, ...]) -> None:
    names = list({"joints": KINDS, "forces": FORCE_KINDS, "contacts": CONTACT_KINDS}[kinds])
    text = "".join((RENDER.parent / "docs" / f"{page}.md").read_text() for page in pages)
    assert names
    assert [name for name in names if not re.search(rf"\b{name}\b", text)] == []
