"""Hatches of cut faces in GLB and USD: stripes of two materials over the whole face, and solids that stay closed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from render.film.film import Film
from render.film.section import LIGHT, Hatch, dark_of, hatch_of, light_of
from render.film.solids import read_triangles
from render.glb.cut import along_rim, faces_of, pieces_of, striped
from shared.contract import read_motion, read_parts
from shared.contract.shot import Section, Shot
from tools.fixtures import film_fixture


def test_a_square_has_stripes_of_its_way_and_period() -> None:
    square = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]], float)
    light, dark = striped(square, Hatch((1.0, 0.0, 0.0), 0.25), 0.6)
    areas = [trimesh.triangles.area(part).sum() for part in (light, dark)]
    assert areas == pytest.approx([0.6, 0.4])
    assert np.all(light[..., 0].max(axis=1) % 0.25 < 0.15 + 1e-9)
    assert np.all((dark[..., 0].min(axis=1) + 1e-12) % 0.25 > 0.15 - 1e-9)
    normals = np.cross(light[:, 1] - light[:, 0], light[:, 2] - light[:, 0])
    assert (normals[:, 2] > 0).all()


def test_edges_along_a_plane_are_split_where_stripes_end() -> None:
    wall = np.array([[[0, 0, 0], [1, 0, 0], [0.5, 0, -1]], [[0, 0, -1], [0.5, 0, -1], [0, 0, 0]]], float)
    split = along_rim(wall, (0.0, 0.0, 1.0, 0.0), Hatch((1.0, 0.0, 0.0), 0.5), 0.5, 1e-9)
    assert len(split) == 1 + 4  # the other triangle has no edge in the plane
    assert trimesh.triangles.area(split).sum() == pytest.approx(trimesh.triangles.area(wall).sum())
    on_it = np.unique(split.reshape(-1, 3)[np.abs(split.reshape(-1, 3)[:, 2]) < 1e-12][:, 0])
    assert on_it == pytest.approx([0, 0.25, 0.5, 0.75, 1])


@pytest.mark.parametrize("section", [Section(front=0.3), Section(right=0.5, above=0.4), Section(right=0.4, fixed=True)])
def test_cut_pieces_are_closed_with_their_stripes(out_root: Path, section: Section) -> None:
    out = film_fixture.write()
    film = Film(read_motion(out.motion), read_parts(out.parts), Shot(section=section), out.parts_folder)
    cut = [piece for piece in pieces_of(film) if piece.cut]
    assert cut
    for piece in cut:
        (rest, own), (light, bright), (dark, shady) = faces_of(read_triangles(Path(piece.stl)), piece, 0.1)
        assert own == piece.surface
        assert (bright.colour, shady.colour) == (light_of(own.colour), dark_of(own.colour))
        parts = np.concatenate([rest, light, dark]).astype(np.float32)
        solid = trimesh.Trimesh(parts.reshape(-1, 3), np.arange(3 * len(parts)).reshape(-1, 3), process=False)
        solid.merge_vertices(digits_vertex=9)
        assert solid.is_watertight, (piece.body, piece.name)
        whole = trimesh.triangles.area(light).sum() + trimesh.triangles.area(dark).sum()
        if whole > 1e-4:  # of some stripes, not of a corner
            assert trimesh.triangles.area(light).sum() / whole == pytest.approx(LIGHT, abs=0.12)


def test_neighbours_lean_otherwise_and_faces_that_stand_have_stripes_along_z() -> None:
    kinds = {hatch_of(f"rod/pin_{k}", (0.0, 0.0, 1.0, 0.0)) for k in range(40)}
    assert len(kinds) == 4
    assert hatch_of("rod/rod", (1.0, 0.0, 0.0, 0.2)).way[:2] == (0.0, 1.0)
    assert abs(hatch_of("rod/rod", (0.0, -1.0, 0.0, 0.2)).way[2]) == 1.0
