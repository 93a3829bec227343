"""The USD stage: opened by OpenUSD, its bodies are where data.json has them, all else where the GLB has it."""

from __future__ import annotations

import io
import math
import sys
import zipfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from render import usd
from render.film.film import Film
from render.film.inputs import read_film
from render.glb.build import glb
from shared.contract import Mount, mounted, read_motion, read_parts
from shared.contract.materials import MATERIALS
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.render.film import test_springs
from tests.render.film.test_belts import drive, filmed
from tests.render.glb_file import GlbFile
from tools.fixtures import film_fixture

pytest.importorskip("pxr", reason="OpenUSD is not installed (extra usd)")

from pxr import Gf, Usd, UsdGeom, UsdShade

CORNER = (0.1, 0.02, 0.03)


@pytest.fixture
def out(out_root: Path) -> Out:
    return film_fixture.write()


def opened(out: Out, form: str = "usd") -> Usd.Stage:
    usd.run(out.name, form)
    return Usd.Stage.Open(str(out.folder / "export" / f"{out.name}{usd.FORMATS[form]}"))


def prims_of(stage: Usd.Stage) -> dict[str, Usd.Prim]:
    """By what things are called in the mechanism: ``crank``, ``crank/pin``."""
    root = stage.GetDefaultPrim()
    prims = {root.GetDisplayName(): root}
    for child in root.GetChildren():
        if child.IsA(UsdGeom.Xformable):
            prims[child.GetDisplayName()] = child
            prims |= {
                f"{child.GetDisplayName()}/{below.GetDisplayName()}": below
                for below in child.GetChildren()
                if below.HasAuthoredDisplayName()
            }
    return prims


def world_place(prim: Usd.Prim, code: float, point: tuple[float, float, float] = CORNER) -> list[float]:
    """Where a point of a prim is in the world."""
    return list(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(code).Transform(Gf.Vec3d(*point)))


@pytest.mark.parametrize("form", usd.FORMATS)
def test_every_body_is_where_data_json_has_it(out: Out, form: str) -> None:
    stage, motion = opened(out, form), read_motion(out.motion)
    prims, rate = prims_of(stage), stage.GetTimeCodesPerSecond()
    for k in (0, 101, 360):
        code = (motion.time[k] - motion.time[0]) * rate
        for name, body in motion.bodies.items():
            c, s = math.cos(body.theta[k]), math.sin(body.theta[k])
            x, y = body.x[k] + c * CORNER[0] - s * CORNER[1], body.y[k] + s * CORNER[0] + c * CORNER[1]
            assert world_place(prims[name], code) == pytest.approx([x, CORNER[2], -y], abs=1e-6)  # y is up
        assert world_place(prims["ground"], code) == pytest.approx([0.1, 0.03, -0.02], abs=1e-12)
    assert world_place(prims["crank"], Usd.TimeCode.Default()) == pytest.approx(
        world_place(prims["crank"], 0.0), abs=1e-12
    )


def test_the_stage_says_its_units_and_its_clock(out: Out) -> None:
    stage, motion = opened(out), read_motion(out.motion)
    assert (UsdGeom.GetStageUpAxis(stage), UsdGeom.GetStageMetersPerUnit(stage)) == ("Y", 1.0)
    assert stage.GetStartTimeCode() == 0.0
    seconds = stage.GetEndTimeCode() / stage.GetTimeCodesPerSecond()
    assert seconds == pytest.approx(motion.time[-1] - motion.time[0])
    assert stage.GetDefaultPrim().GetName() == "four_bar"
    assert stage.GetFramesPerSecond() == stage.GetTimeCodesPerSecond() >= 24


@pytest.mark.parametrize("gravity", [(0.0, 0.0), (0.0, -9.81), (3.0, 4.0)])
def test_the_upward_axis_is_y(out_root: Path, gravity: tuple[float, float]) -> None:
    mount = mounted(gravity)
    stage = opened(film_fixture.write(mount=mount))
    assert world_place(prims_of(stage)["ground"], 0.0, mount.up) == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)


def test_meshes_and_materials_are_those_of_the_parts(out: Out) -> None:
    stage = opened(out)
    prims = prims_of(stage)
    for body, pieces in film_fixture.solids().items():
        for piece, (mesh, material) in pieces.items():
            prim = prims[f"{body}/{piece}"]
            points = np.array(UsdGeom.Mesh(prim).GetPointsAttr().Get(), float)
            corners = np.array(UsdGeom.Mesh(prim).GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
            assert len(corners) == len(mesh.faces)
            volume = np.einsum("ij,ij->", points[corners[:, 0]], np.cross(points[corners[:, 1]], points[corners[:, 2]]))
            assert volume / 6 * 1e9 == pytest.approx(mesh.volume, rel=1e-5)
            surface = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0].ComputeSurfaceSource()[0]
            assert surface.GetInput("roughness").Get() == pytest.approx(MATERIALS[material].roughness)
            if material == "brass":
                assert list(surface.GetInput("diffuseColor").Get()) == pytest.approx(MATERIALS["brass"].colour)
    meshes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    assert len(meshes) == sum(len(pieces) for pieces in film_fixture.solids().values())


@pytest.mark.parametrize("form", usd.FORMATS)
def test_openusd_has_nothing_to_say_against_it(out: Out, form: str) -> None:
    validation = pytest.importorskip("pxr.UsdValidation")
    checks = validation.ValidationRegistry().GetOrLoadAllValidators()
    assert validation.ValidationContext(checks).Validate(opened(out, form)) == []


def same_as_glb(film: Film, folder: Path) -> set[str]:
    """Compare every mesh at three times with that of the GLB, which has its own tests; the names of the meshes."""
    from render.usd.scene import stage_of

    path = folder / "scene.usdc"
    folder.mkdir(parents=True, exist_ok=True)
    path.write_bytes(usd.content(stage_of(film), "scene", "usd"))
    stage, read = Usd.Stage.Open(str(path)), GlbFile(glb(film))
    prims, meshes = prims_of(stage), {name for name, node in read.nodes.items() if "mesh" in node}
    for k in (0, len(film.motion.time) // 3, len(film.motion.time) - 1):
        seconds = film.motion.time[k] - film.motion.time[0]
        code, matrices = seconds * stage.GetTimeCodesPerSecond(), read.matrices(seconds)
        for name in meshes:
            theirs, ours = _points(read, name, matrices[name]), _world_points(prims[name], code)
            assert ours == pytest.approx(theirs, abs=5e-4 if len(read.weights[name]) else 2e-6), name
    return meshes


def _points(read: GlbFile, name: str, matrix: np.ndarray) -> np.ndarray:
    """(n, 3) of all parts of a mesh, in the world."""
    parts = []
    for part in read.json["meshes"][read.nodes[name]["mesh"]]["primitives"]:
        points = read.array(part["attributes"]["POSITION"]).astype(float)
        for weight, target in zip(read.weights[name], part.get("targets", []), strict=True):
            points = points + weight * read.array(target["POSITION"])
        parts.append(points)
    points = np.concatenate(parts)
    return (np.column_stack([points, np.ones(len(points))]) @ matrix.T)[:, :3]


def _world_points(prim: Usd.Prim, code: float) -> np.ndarray:
    below = [prim] if prim.IsA(UsdGeom.Mesh) else prim.GetChildren()
    points = np.concatenate([np.array(UsdGeom.Mesh(part).GetPointsAttr().Get(code), float) for part in below])
    matrix = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(code))  # rows: points stand on its left
    return (np.column_stack([points, np.ones(len(points))]) @ matrix)[:, :3]


@pytest.mark.parametrize("rope", [None, 0.6])
def test_springs_and_ropes_are_where_the_glb_has_them(out_root: Path, rope: float | None) -> None:
    film = test_springs.film() if rope is None else test_springs.film(rope=rope)
    names = same_as_glb(film, out_root)
    assert len(names) > sum(len(pieces) for pieces in film_fixture.solids().values())


def test_a_torsion_spring_winds_as_in_the_glb(out: Out) -> None:
    motion = test_springs.with_spring(read_motion(out.motion))
    film = Film(motion, read_parts(out.parts), Shot(), out.parts_folder)
    assert "spring" in same_as_glb(film, out.folder)


@pytest.mark.parametrize("teeth", [None, (17, 34)])
def test_belts_and_chains_run_as_in_the_glb(out_root: Path, teeth: tuple[int, int] | None) -> None:
    belt, poses = filmed(drive(teeth=teeth))
    no: list[Any] = []
    film: Any = SimpleNamespace(
        motion=poses.motion, poses=poses, in_space=None, belts=[belt], cables=no, stretched=no, spirals=no,
        parts=SimpleNamespace(mount=Mount()),
        scene=SimpleNamespace(pieces=no), cut=(), rollers=SimpleNamespace(found=no),
    )  # fmt: skip
    names = same_as_glb(film, out_root)
    assert any("link" in name for name in names) == bool(teeth)
    assert len(names) > 3


def test_names_that_usd_does_not_know_are_shown_as_they_are(out_root: Path) -> None:
    out = film_fixture.write(name="four_bar")
    parts, motion = read_parts(out.parts), read_motion(out.motion)
    for document in (parts, motion):
        document.bodies["rod 1"] = document.bodies.pop("coupler")
        document.bodies["rod_1"] = document.bodies.pop("rocker")
    motion.points.clear()
    film = Film(motion, parts, Shot(), out.parts_folder)
    from render.usd.scene import stage_of

    stage = stage_of(film)
    prims = prims_of(stage)
    assert [str(prims[name].GetPath()) for name in ("rod 1", "rod_1")] == ["/four_bar/rod_1", "/four_bar/rod_1_2"]
    assert str(prims["rod 1/start"].GetPath()) == "/four_bar/rod_1/start"


def test_the_same_scene_has_the_same_bytes(out: Out) -> None:
    from render.usd.scene import stage_of

    first, second = (usd.content(stage_of(read_film(out)), out.name, "usd") for _ in range(2))
    assert first == second


def test_a_package_knows_no_time() -> None:
    """OpenUSD writes when the file was packed."""
    archives = []
    for year in (1999, 2026):
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w") as archive:
            for name in ("scene.usdc", "picture.png"):
                archive.writestr(zipfile.ZipInfo(name, (year, 7, 9, 12, 30, 2)), name)
        archives.append(content.getvalue())
    assert archives[0] != archives[1]
    first, second = map(usd.without_times, archives)
    assert first == second
    with zipfile.ZipFile(io.BytesIO(first)) as archive:
        assert archive.testzip() is None
        assert [(file.date_time, archive.read(file).decode()) for file in archive.infolist()] == [
            ((1980, 1, 1, 0, 0, 0), "scene.usdc"), ((1980, 1, 1, 0, 0, 0), "picture.png"),
        ]  # fmt: skip


def test_a_short_motion_has_pictures_enough() -> None:
    from render.usd.scene import Clock

    slow, quick = Clock(np.linspace(3.0, 13.0, 11)), Clock(np.array([0.0, 0.01]))
    assert (slow.rate, slow.codes[1], slow.last) == pytest.approx((24.0, 24.0, 240.0))
    assert quick.last >= 48


def test_without_openusd_it_says_how_to_get_it(out: Out, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(UserError, match=r"four_bar: OpenUSD is not installed; run: pip install 'mbsd\[usd\]'"):
        usd.run("four_bar")


def test_another_format_and_missing_parts_are_refused(out_root: Path) -> None:
    with pytest.raises(UserError, match=r"no format 'usdx'; choose one of: usd, usdz; did you mean 'usd"):
        usd.run("four_bar", "usdx")
    with pytest.raises(UserError, match="run make solve-four-bar first"):
        usd.run("four_bar")
