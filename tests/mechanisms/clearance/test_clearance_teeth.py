"""A disc that bounces and slides on a wheel of sharp teeth: what the proof of its gap costs."""

from __future__ import annotations

import math

import numpy as np
import pytest
from manifold3d import CrossSection

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.layout.curves import curve_path
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import Search
from mechanisms.stages.clearance.stage import check
from mechanisms.stages.solve.motion_file import to_motion
from tests.mechanisms.clearance.clearance_pieces import disc, parts_of

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
    pieces = [
        MeshPiece("wheel", "disc", triangles),
        disc("lever", "roller", 90.0, 0.0, 1e3 * ROLLER - ROOM, 1.0, 6.0),
    ]
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
