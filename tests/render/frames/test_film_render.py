"""Real pictures from Blender, at the size of a postage stamp."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PIL import Image

from mechanisms.four_bar.shot import shot as four_bar_shot
from render.blender.child import blender
from render.blender.job import Job, Picture
from render.film.film import Film
from render.film.framing import project
from render.film.inputs import read_film
from render.frames import blend, film, frames, still
from render.frames.store import FrameIndex, FrameStore, Timing
from render.presets import PRESETS, Preset
from shared.contract import Rolling, mounted, read_parts, write_motion, write_parts
from shared.contract.shot import Camera, Label, Shot, write_shot
from shared.stage import jsonfile
from shared.stage.paths import ROOT, Out
from tests.render.planar import in_plane
from tools.fixtures import film_fixture

TINY = Preset("tiny", 96, 54, 2)
BLURRED = Preset("blurred", 96, 54, 2, motion_blur=True)
SHORT = Shot(turns=3, seconds_per_turn=0.2, labels=(Label(at="B", text="B"),))


def pixels(path: Path) -> np.ndarray:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB")).astype(int)


def stamps(store: FrameStore) -> dict[str, int]:
    """Pictures that are there, and when they were written; half-written ones have a dot before their names."""
    return {path.name: path.stat().st_mtime_ns for path in store.folder.glob("[!.]*.png")}


def test_three_turns_cost_one_and_a_changed_colour_costs_all(out_root: Path, capsys: pytest.CaptureFixture[str]):
    out = film_fixture.write(SHORT)
    film.run("four-bar", TINY)
    said = capsys.readouterr().out
    assert "tiny (96x54, 2 samples, no blur): 6 of 6 pictures to render, 18 frames in the film" in said
    assert "device: " in said
    assert "forecast" in said
    store = FrameStore(out.frames("tiny"))
    index = jsonfile.read(store.index, FrameIndex)
    assert len(index.frames) == 18
    assert index.frames[:6] == index.frames[6:12] == index.frames[12:]
    assert len(stamps(store)) == 6
    timing = jsonfile.read(store.timing, Timing)
    assert timing.rendered == 6
    assert timing.wall > timing.cycles > 0
    first = stamps(store)
    content = out.film("tiny").read_bytes()

    film.run("four-bar", TINY)
    assert "nothing to do" in capsys.readouterr().out

    damaged = store.folder / index.frames[2]
    whole = pixels(damaged)
    damaged.write_bytes(damaged.read_bytes()[:-100])
    out.film("tiny").unlink()
    film.run("four-bar", TINY)
    said = capsys.readouterr().out
    assert f"{damaged.name} is not the picture that was rendered any more; it is rendered again" in said
    assert "1 of 6 pictures to render" in said
    again = jsonfile.read(store.index, FrameIndex)
    assert np.array_equal(pixels(store.folder / again.frames[2]), whole)
    assert jsonfile.read(store.timing, Timing) == timing  # one picture says little about the pace
    assert out.film("tiny").read_bytes() == content
    assert {name for name, at in stamps(store).items() if first.get(name) != at} == {again.frames[2]}
    index = again

    write_shot(out.shot, msgspec.structs.replace(SHORT, materials={"crank": "brass"}))
    film.run("four-bar", TINY)
    assert "6 of 6 pictures to render" in capsys.readouterr().out
    assert len(stamps(store)) == 12  # the film before it is kept, in case the colour comes back
    write_shot(out.shot, SHORT)
    film.run("four-bar", TINY)
    assert "0 of 6 pictures to render" in capsys.readouterr().out

    still.still("four_bar", TINY, 8)
    assert "1 of 1 pictures to render" not in capsys.readouterr().out
    still.poster("four_bar", TINY)
    assert "tiny_poster (96x54, 128 samples" in capsys.readouterr().out
    assert np.array_equal(pixels(out.stills / "tiny-0008.png"), pixels(store.folder / index.frames[2]))
    assert out.poster.is_file()
    assert not [path for path in out_root.rglob("*") if "tmp-" in path.name or ".part." in path.name]


def test_two_processes_give_the_same_pixels_and_the_floor_does_not_flicker(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    shot = Shot(turns=1, seconds_per_turn=0.1, fps=30)
    pictures = []
    for place in ("here", "there"):
        monkeypatch.setenv("MBSD_OUT", str(tmp_path / place))
        out = film_fixture.write(shot)
        frames.run("four_bar", TINY)
        index = jsonfile.read(FrameStore(out.frames("tiny")).index, FrameIndex)
        pictures.append([pixels(out.frames("tiny") / name) for name in index.frames])
    assert all(np.array_equal(a, b) for a, b in zip(*pictures, strict=True))
    first, second = pictures[0][:2]
    assert not np.array_equal(first, second)
    corners = [(slice(0, 8), slice(0, 12)), (slice(0, 8), slice(84, 96)), (slice(46, 54), slice(84, 96))]
    for corner in corners:
        assert np.abs(first[corner] - second[corner]).mean() < 2.0
    assert first.std() > 15  # there is something to see
    assert 20 < first.mean() < 160


def test_blur_smears_what_moves(out_root: Path):
    out = film_fixture.write(Shot(turns=1, seconds_per_turn=0.2, trails=()))
    for preset in (TINY, BLURRED):
        still.still("four_bar", preset, 2)
    sharp, blurred = (pixels(out.stills / f"{preset.name}-0002.png") for preset in (TINY, BLURRED))
    change = np.abs(sharp - blurred).sum(axis=2)
    assert change.max() > 60
    assert np.median(change) <= 3  # the studio stands still


@pytest.mark.parametrize("name", ["four_bar", "default", "standing"])
def test_pins_are_within_a_pixel_of_where_the_solver_has_them(out_root: Path, name: str):
    """Balls on the pins of the STL solids, through poses, timeline and camera, against the joints of data.json.

    One of them is a roller, which is placed by its own axis.
    """
    shot = msgspec.structs.replace(four_bar_shot, trails=None) if name == "four_bar" else Shot()
    if name == "standing":
        shot = Shot(camera=Camera(orbit=12))
    shot = msgspec.structs.replace(shot, seconds_per_turn=4.0, fps=30, labels=(), materials={})
    out = film_fixture.write(shot, mount=mounted((0.0, -9.81)) if name == "standing" else None)
    parts = read_parts(out.parts)
    parts.bodies["coupler"].pieces["end"].rolls = Rolling(joint="C", x=0.12, y=0.0, radius=0.003, marks=1)
    write_parts(out.parts, parts)
    seen = read_film(out)
    colours = {
        "crank/start": ("A", (1.0, 0.0, 0.0)),
        "coupler/start": ("B", (0.0, 1.0, 0.0)),
        "coupler/end": ("C", (0.0, 0.0, 1.0)),
        "rocker/start": ("D", (1.0, 1.0, 0.0)),
    }
    width, height, chosen = 320, 180, [0, 23, 61, 100]
    job = Job(
        scene=seen.scene,
        states=[seen.state(frame) for frame in chosen],
        pictures=[Picture(state=i, folder=str(out_root), key=f"pins{i}", name="pins") for i in range(len(chosen))],
        width=width,
        height=height,
        samples=16,
        flat={piece: colour for piece, (_, colour) in colours.items()},
    )
    with blender(job) as answers:
        paths = [Path(answer.path) for answer in answers if answer.path]
    assert [path.name.partition("-")[0] for path in paths] == [f"pins{i}" for i in range(len(chosen))]
    moved = []
    for i, frame in enumerate(chosen):
        picture = pixels(paths[i])
        for piece, (joint, colour) in colours.items():
            body = piece.split("/")[0]
            series = seen.motion.joints[joint]
            sample = frame * 3  # 361 samples, 120 frames a turn
            z = film_fixture.LAYERS[body] + film_fixture.BALL_HEIGHT
            expected = project(seen.camera(frame), np.array([[series.x[sample], series.y[sample], z]]), width, height)
            centre, amount = centroid(picture, colour)
            assert amount > 10
            assert np.abs(centre - expected[0]).max() < 1.0, (joint, frame, centre, expected)
            moved.append((joint, *centre))
    assert len({round(x) for joint, x, _ in moved if joint == "B"}) > 2


def centroid(picture: np.ndarray, colour: tuple[float, float, float]) -> tuple[np.ndarray, float]:
    """Middle (x, y) and number of the pixels of one flat colour; pixel centres are at halves."""
    on = [i for i in range(3) if colour[i]]
    off = [i for i in range(3) if not colour[i]]
    # An edge pixel is a part of its colour; another colour shows in a channel this one lacks, or lacks one it has.
    weight = picture[:, :, on].min(axis=2) / 255.0
    weight[picture[:, :, off].max(axis=2) > 4] = 0
    if len(on) == 1:
        others = [i for i in range(3) if i != on[0]]
        weight[picture[:, :, others].max(axis=2) > 4] = 0
    rows, columns = np.mgrid[: picture.shape[0], : picture.shape[1]] + 0.5
    total = weight.sum()
    return np.array([(columns * weight).sum(), (rows * weight).sum()]) / total, float(total)


READ_BACK = """
import json, sys, bpy
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
scene, found = bpy.context.scene, {}
for frame in json.loads(sys.argv[2]):
    scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    for thing in ("crank", "coupler", "rocker"):
        matrix = bpy.data.objects[thing].evaluated_get(graph).matrix_world
        found[f"{thing} {frame}"] = [matrix[0][3], matrix[1][3], matrix[0][0], matrix[1][0]]
    trail = bpy.data.objects["trail P"].evaluated_get(graph).data
    ring = [trail.vertices[i].co for i in range(40, 50)]  # after the rings of the round cap
    found[f"trail {frame}"] = [sum(v[k] for v in ring) / 10 for k in range(2)]
found["range"] = [scene.frame_start, scene.frame_end, scene.render.fps]
open(sys.argv[3], "w").write(json.dumps(found))
"""


def test_the_saved_scene_plays_the_motion(out_root: Path, tmp_path: Path):
    shot = Shot(seconds_per_turn=0.4)
    film_fixture.write(shot)
    scene = blend.save("four_bar", PRESETS["preview"])
    at = [0, 3, 7, 11]
    answer = tmp_path / "found.json"
    environment = dict(
        os.environ, BLENDER_USER_RESOURCES=str(tmp_path / "user"), XDG_CACHE_HOME=str(tmp_path / "cache")
    )
    subprocess.run(
        [sys.executable, "-c", READ_BACK, str(scene), json.dumps(at), str(answer)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        check=True,
        timeout=120,
    )
    played = json.loads(answer.read_text())
    seen: Film = read_film(Out("four_bar"))
    for frame in at:
        state = seen.state(frame)
        for body in film_fixture.LENGTHS:
            x, y, theta = in_plane(state.bodies[body])
            assert played[f"{body} {frame}"] == pytest.approx([x, y, np.cos(theta), np.sin(theta)], abs=2e-6)
        assert played[f"trail {frame}"] == pytest.approx(state.trails[0][0][:2], abs=2e-6)
    assert played["range"] == [0, 11, 30]
    assert not list(out_root.rglob("*.part.*"))


def test_a_motion_that_does_not_repeat_is_held_at_its_end_and_begins_anew(
    out_root: Path, capsys: pytest.CaptureFixture[str]
):
    out = film_fixture.write(Shot(turns=2, rate=5.0, hold=0.1, fps=30))
    once = msgspec.structs.replace(read_film(out).motion, period=None)
    write_motion(out.motion, once)
    film.run("four-bar", TINY)
    said = capsys.readouterr().out
    assert "2 x 0.2 s and 0.1 s held at the end, 5 times faster" in said
    assert "7 of 7 pictures to render, 18 frames in the film" in said  # six that move and the one that is held
    index = jsonfile.read(FrameStore(out.frames("tiny")).index, FrameIndex)
    assert index.frames[:9] == index.frames[9:]
    assert len(set(index.frames[6:9])) == 1
    assert len(set(index.frames[:7])) == 7
