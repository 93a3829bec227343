"""The proof of clearance for gears in mesh: wheels, and teeth by themselves."""

from __future__ import annotations

import math

import manifold3d
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import CrossSection

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.layout.curves import curve_path
from mechanisms.stages.clearance.meshing import Gears, least_in_mesh
from mechanisms.stages.clearance.outlines import least_gap
from mechanisms.stages.clearance.path import BodyPath
from mechanisms.stages.clearance.pieces import MeshPiece, order, turned_union
from mechanisms.stages.clearance.search import RESOLUTION, Least, Search, Sweep
from mechanisms.stages.clearance.stage import check
from mechanisms.stages.solve.motion_file import to_motion
from shared.shapes.involute import longest_tip, toothed
from tests.mechanisms.clearance.clearance_pieces import disc, parts_of

# Gears in mesh: one pitch proves what the search over the whole motion finds, and odd wheels are left to that.


PLAY = 0.12
"""Taken from each tooth (mm)."""


def wheel(body: str, outline: np.ndarray, rim: float = 0.0) -> MeshPiece:
    """A prism 4 mm high on an outline; with ``rim`` a ring of that radius around it."""
    section = manifold3d.CrossSection([outline])
    if rim:
        section = manifold3d.CrossSection.circle(rim, 128) - section
    mesh = manifold3d.Manifold.extrude(section, 4.0).to_mesh()
    return MeshPiece(body, body, mesh.vert_properties[:, :3][mesh.tri_verts].astype(float))


def turning(rate: float, turns: float, phase: float = 0.0, x: float = 0.0, per_turn: int = 120) -> BodyPath:
    """About (x, 0), at a rate (rad/s), for so many seconds of which each is a turn of the fastest."""
    time = np.linspace(0.0, turns, round(per_turn * turns) + 1)
    ones, zeros = np.ones_like(time), np.zeros_like(time)
    return BodyPath(
        time,
        np.column_stack([x * ones, zeros, phase + rate * time]),
        np.column_stack([zeros, zeros, rate * ones]),
        np.zeros((len(time), 3)),
    )


class Pair:
    """Two wheels of 1 mm module, a ring the first of them, as ``a`` and ``b`` at a distance along x."""

    def __init__(self, teeth: tuple[int, int], ring: bool = False, turns: float = 1.0, late: float = 0.0) -> None:
        """``late``: by how much of a pitch the second is turned from where it meshes."""
        radius_a, radius_b = (n / 2 for n in teeth)
        self.teeth, self.ring, self.apart = teeth, ring, radius_a - radius_b if ring else radius_a + radius_b
        pitch = 2 * math.pi / teeth[1]
        if ring:
            hole = toothed(teeth[0], 1.0, radius_a + 1.25, radius_a - 0.75, -PLAY, math.pi / teeth[0])
            first = wheel("a", hole, radius_a + 4.0)
            second = toothed(teeth[1], 1.0, radius_b + 0.9, radius_b - 1.25, PLAY)
            phase = pitch / 2
        else:
            tips = [min(r + 1.0, longest_tip(r, other)) for r, other in ((radius_a, radius_b), (radius_b, radius_a))]
            first = wheel("a", toothed(teeth[0], 1.0, tips[0], radius_a - 1.25, PLAY))
            second = toothed(teeth[1], 1.0, tips[1], radius_b - 1.25, PLAY)
            phase = math.pi + pitch / 2
        self.pieces = (first, wheel("b", second))
        sense = 1.0 if ring else -1.0
        self.where = {
            "a": turning(2 * math.pi * teeth[1] / teeth[0], turns),
            "b": turning(sense * 2 * math.pi, turns, phase + pitch * late, self.apart),
        }

    @property
    def gears(self) -> Gears:
        return Gears(("a", "b"), (np.zeros(2), np.zeros(2)), self.teeth, self.ring)

    def sweep(self, turned: bool = False) -> Sweep:
        first, second = self.pieces[::-1] if turned else self.pieces
        return Sweep(first, second, self.where[first.body], self.where[second.body])

    def by_pitch(self, turned: bool = False) -> Least | None:
        return least_in_mesh(self.sweep(turned), {frozenset("ab"): [self.gears]}, self.where)


@settings(max_examples=6, deadline=None)
@given(st.integers(12, 28), st.integers(12, 20), st.booleans(), st.booleans())
def test_one_pitch_tells_what_the_whole_motion_does(first: int, second: int, ring: bool, turned: bool) -> None:
    pair = Pair((first + 24, second) if ring else (first, second), ring, turns=0.5)
    by_pitch, whole = pair.by_pitch(turned), least_gap(pair.sweep(turned), 5.0)
    assert by_pitch is not None
    assert by_pitch.gap == pytest.approx(whole.gap, abs=RESOLUTION)
    assert 0.05 < whole.gap - 2 * RESOLUTION < by_pitch.proven <= by_pitch.gap
    assert pair.sweep().gap_at(by_pitch.time, 5.0) == pytest.approx(by_pitch.gap, abs=1e-6)


def test_more_turns_cost_no_more() -> None:
    few, many = Pair((18, 18), turns=0.5).by_pitch(), Pair((18, 18), turns=10.0).by_pitch()
    assert few is not None
    assert many is not None
    assert many.gap == pytest.approx(few.gap, abs=RESOLUTION)
    assert many.poses <= few.poses + 10


@pytest.mark.parametrize("late", [0.5, 0.2])
def test_wheels_out_of_phase_are_left_to_the_search_that_tells_their_collision(late: float) -> None:
    pair = Pair((18, 24), late=late)
    assert pair.by_pitch() is None
    assert least_gap(pair.sweep(), 5.0).gap == 0


def test_one_thick_tooth_is_found_though_its_turn_comes_once() -> None:
    """The teeth of a sector that collide at a single moment are in every copy of the wheel."""
    pair = Pair((20, 16), turns=2.0)
    good, outline = pair.pieces[1], toothed(16, 1.0, 9.0, 6.75, PLAY)
    count = len(outline) // 16
    outline[5 * count : 6 * count] = toothed(16, 1.0, 9.0, 6.75, -0.5)[5 * count : 6 * count]
    pair.pieces = (pair.pieces[0], wheel("b", outline))
    assert len(good.triangles) == len(pair.pieces[1].triangles)
    assert pair.by_pitch() is None


def test_a_motion_that_is_not_rolling_is_left_to_the_search() -> None:
    pair = Pair((18, 18), turns=1.0)
    pair.where["a"] = turning(6.2, 1.0)
    assert pair.by_pitch() is None


def test_unions_of_equal_teeth_are_the_wheel_itself() -> None:
    outline = toothed(18, 1.0, 10.0, 7.75, PLAY)
    piece = wheel("a", outline + np.array([3.0, -2.0]))
    sides = piece.triangles[~piece.level]
    union = turned_union(sides, np.array([3.0, -2.0]), 18, (0.0, 99.0))
    assert union is not None
    assert len(sides) <= len(union.triangles) <= 2 * len(sides)
    assert union.spread < 1e-5
    assert turned_union(sides, np.array([3.0, -2.0]), 17, (0.0, 99.0)) is None
    assert order([piece], "a", np.array([3.0, -2.0]), 9.0) == 18
    assert order([piece], "b", np.zeros(2), 9.0) == 1


# A disc that bounces and slides on a wheel of sharp teeth: what the proof of its gap costs.


TEETH, RADIUS, ROLLER, ROOM = 15, 0.1, 0.003, 0.1
"""m; room in mm."""
SAW = ((0.0, 1.0), (0.08, 0.8), (0.5, 0.86))
"""Places of a tooth: parts of its pitch, and of the radius."""


def _escapement() -> tuple[Mechanism, list[tuple[float, float]]]:
    """A driven wheel with a lever whose roller is pressed on it, and the points of the wheel's teeth."""
    m = Mechanism("escapement")
    turn = [-2 * math.pi * (tooth + part) / TEETH for tooth in range(TEETH) for part, _ in SAW]
    away = [RADIUS * part for _ in range(TEETH) for _, part in SAW]
    points = [(r * math.cos(t), r * math.sin(t)) for r, t in zip(away, turn, strict=True)]
    wheel, lever = m.body("wheel", 1.0, inertia=0.01), m.body("lever", 0.3, (0.03, 0.0), 0.003)
    m.revolute("O", m.ground.origin, wheel.origin)
    m.revolute("P", m.ground.at(-0.09, 0.11), lever.origin)
    m.rigid_terrain("touch", wheel.origin, lever.at(0.09, 0.0), points, ROLLER, closed=True)
    m.torsion_spring("back", m.ground, lever, 1.0, free_angle=-0.5, damping=0.01)
    m.drive_angle("motor", wheel, constant_rate(3.0))
    m.start_near(wheel=0, lever=0)
    return m, points


def test_a_disc_on_a_wheel_of_many_teeth_is_proven_with_little_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the candidates that the search looks at, of which it gives up at thirty millions."""
    m, points = _escapement()
    solution = m.simulate(1.0, steps=360, event_rows=True)
    assert sum(event.what == "impact" for event in solution.events) > 3
    outline = CrossSection([1e3 * curve_path(points, True)[::-1]])
    mesh = outline.extrude(7.0).to_mesh64()
    triangles = np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts).astype(int)]
    pieces = [MeshPiece("wheel", "disc", triangles), disc("lever", "roller", 90.0, 0.0, 1e3 * ROLLER - ROOM, 1.0, 6.0)]
    looked: list[int] = []
    plain = Search.run

    def counted(search: Search, *asked: float) -> object:
        nearest = plain(search, *asked)
        looked.append(search.looked)
        return nearest

    monkeypatch.setattr(Search, "run", counted)
    masses = dict.fromkeys(("wheel", "lever"), "mechanism")
    (pair,) = check(parts_of(pieces), to_motion(solution, None, "", {}, masses), pieces, "0" * 64).pairs
    assert pair.proof == "motion"
    assert 1e3 * pair.gap == pytest.approx(ROOM, abs=0.03)
    assert 0.025 < 1e3 * pair.proven <= 1e3 * pair.gap
    assert len(triangles) > 1000
    assert sum(looked) < 300_000
