"""A frame's key is what it shows: the same picture has one key, another picture another."""

from __future__ import annotations

import ast
import shutil
from pathlib import Path

import msgspec
import pytest

from render.film.film import Film
from render.film.inputs import SHARED, stage_key
from render.film.poses import planar_pose
from render.frames import keys as render_keys
from render.frames.frames import Pictures
from render.frames.keys import frame_key, scene_key
from render.presets import PRESETS
from shared.contract import read_motion, read_parts
from shared.contract.shot import Camera, Label, Shot, Surface, Trail, read_shot, write_shot
from shared.stage import stages
from shared.stage.paths import ROOT
from shared.stage.stages import contract_sources
from tests.render.planar import in_plane
from tools.fixtures import film_fixture

SHOT = Shot(seconds_per_turn=0.4)


def pictures(shot: Shot = SHOT, preset: str = "preview") -> Pictures:
    out = film_fixture.write(shot)
    film = Film(read_motion(out.motion), read_parts(out.parts), read_shot(out.shot), out.parts_folder)
    return Pictures(film, PRESETS[preset])


def keys(made: Pictures) -> list[str]:
    return [made.key(frame) for frame in range(made.film.clock.frames)]


def test_presets_are_the_published_ones():
    sizes = {p.name: (p.width, p.height, p.samples, p.motion_blur) for p in PRESETS.values()}
    assert sizes["preview"] == (1280, 720, 8, False)
    assert sizes["production"] == (1920, 1080, 16, False)
    assert sizes["final"] == (3840, 2160, 64, True)
    assert set(sizes) == {"draft", "preview", "production", "final"}


def test_the_second_turn_shows_the_pictures_of_the_first(out_root: Path):
    made = pictures()
    count = made.film.clock.frames
    for frame in range(count):
        first, second = made.film.state(frame), made.film.state(frame + count)
        assert frame_key("", [first]) == frame_key("", [second])
    assert len(set(keys(made))) == count


def test_the_key_does_not_depend_on_where_the_files_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    by_place = []
    for place in ("here", "there"):
        monkeypatch.setenv("MBSD_OUT", str(tmp_path / place))
        by_place.append(keys(pictures()))
    assert by_place[0] == by_place[1]


@pytest.mark.parametrize(
    "change",
    [
        {"camera": Camera(azimuth=-17.0)},
        {"camera": Camera(blur=2.0)},
        {"look": "daylight"},
        {"trails": ()},
        {"trails": (Trail(point="P", colour=(0.0, 0.5, 1.0)),)},
        {"labels": (Label(at="A", text="A"),)},
        {"materials": {"crank": "brass"}},
        {"materials": {"crank/start": Surface(colour=(1.0, 0.0, 0.0))}},
    ],
    ids=str,
)
def test_what_shows_changes_every_key(out_root: Path, change: dict):
    before = keys(pictures())
    after = keys(pictures(msgspec.structs.replace(SHOT, **change)))
    assert not set(before) & set(after)


@pytest.mark.parametrize("change", [{"turns": 7}, {"poster": 0.9}])
def test_what_does_not_show_changes_none(out_root: Path, change: dict):
    assert keys(pictures()) == keys(pictures(msgspec.structs.replace(SHOT, **change)))


def test_half_the_frame_rate_finds_its_pictures_made(out_root: Path):
    slow = keys(pictures(msgspec.structs.replace(SHOT, fps=15)))
    assert slow == keys(pictures())[::2]


def test_preset_and_blender_are_a_part_of_the_key(out_root: Path):
    made = pictures()
    scenes = {scene_key(made.film.scene, preset, version) for preset in PRESETS.values() for version in ("5.2", "5.3")}
    assert len(scenes) == 2 * len(PRESETS)


def test_an_edit_of_what_blender_runs_changes_every_key(
    out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    before = keys(pictures())
    copy = tmp_path / "blender"
    shutil.copytree(render_keys.BLENDER, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(render_keys, "BLENDER", copy)
    assert keys(pictures()) == before
    for file in ("regions/regions.py", "scene/built_scene.py", "worker/worker.py"):
        (copy / file).write_text((copy / file).read_text() + "\n# brighter\n")
        after = keys(pictures())
        assert not set(before) & set(after)
        before = after


def test_blenders_side_takes_nothing_from_outside_that_no_key_holds():
    numbers, telling = (
        {"SENSOR", "MILLIMETRE", "Z", "studio", "half_field"},
        {"picture_file", "errors", "files", "signals"},
    )
    blender = [f"render.blender.{part}" for part in ("job", "regions", "scene", "worker")]
    inside = (*blender, "render.film.scene", "render.letters", "render.film.section", "render.looks")
    places = [render_keys.BLENDER / name for name in render_keys.BLENDER_SOURCES]
    for file in [file for place in places for file in (place.rglob("*.py") if place.is_dir() else [place])]:
        for node in ast.walk(ast.parse(file.read_text())):
            module = getattr(node, "module", None) or ""
            if module.startswith(("render.", "shared.")) and not (
                module.startswith(inside) or module.rpartition(".")[2] in telling
            ):
                assert isinstance(node, ast.ImportFrom)
                assert {alias.name for alias in node.names} <= numbers, f"{file}: {module}"


def test_every_shared_file_that_decides_what_is_seen_is_in_the_key_of_the_stages():
    """What motion and parts hold is in it anyway; shared/stage finds and checks files, shared/cluster deals out."""
    always = {path.stem for path in contract_sources()}
    used: set[str] = set()
    rooms = (file for room in ("film", "frames", "blender") for file in (ROOT / "render" / room).rglob("*.py"))
    for file in (*rooms, ROOT / "render" / "freshness.py"):  # stories take the clearance from there
        for node in ast.walk(ast.parse(file.read_text())):
            module = (getattr(node, "module", None) or "") if isinstance(node, ast.ImportFrom) else ""
            if module.startswith("shared.contract."):
                used.add(module.split(".")[2])
            else:
                deciding = module.startswith("shared.") and not module.startswith(("shared.stage", "shared.cluster"))
                assert module == "shared.contract" or not deciding, module
    assert used - always == set(SHARED)


def test_another_colour_of_a_material_makes_the_pictures_again(
    out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    out = film_fixture.write(SHOT)
    before = stage_key(out, PRESETS["draft"])
    for folder in ("shared", "mbsd/base"):  # units come from there
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(stages, "ROOT", tmp_path)
    assert stage_key(out, PRESETS["draft"]) == before
    file = tmp_path / "shared" / "contract" / "materials.py"
    file.write_text(file.read_text().replace("(0.85, 0.17, 0.02)", "(0.86, 0.17, 0.02)"))
    assert stage_key(out, PRESETS["draft"]) != before


def test_only_blur_makes_neighbours_count(out_root: Path):
    for preset, counts in (("preview", False), ("final", True)):
        made = pictures(preset=preset)
        before = made.key(3)
        moved = msgspec.structs.replace(
            made.state(4), bodies={**made.state(4).bodies, "crank": planar_pose(0.1, 0.0, 0.0)}
        )
        made._states[4] = moved
        assert (made.key(3) != before) == counts


def test_a_pose_counts_to_a_nanometre(out_root: Path):
    made = pictures()
    state = made.state(0)
    x, y, theta = in_plane(state.bodies["rocker"])

    def key(dx: float) -> str:
        return frame_key(made.scene, [msgspec.structs.replace(state, bodies={"rocker": planar_pose(x + dx, y, theta)})])

    assert key(1e-12) == key(0.0)
    assert key(1e-8) != key(0.0)
    zero = [msgspec.structs.replace(state, bodies={"rocker": planar_pose(sign * 0.0, y, theta)}) for sign in (1, -1)]
    assert frame_key("", zero[:1]) == frame_key("", zero[1:])


def test_a_shot_that_was_only_written_again_is_the_same(out_root: Path):
    before = keys(pictures())
    out = film_fixture.write(SHOT)
    write_shot(out.shot, read_shot(out.shot))
    assert keys(pictures()) == before
