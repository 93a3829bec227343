"""The gallery: small posters, two sentences, numbers of the motion; only mechanisms that have a poster."""

from __future__ import annotations

import io
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PIL import Image

from render import freshness, gallery
from render.gallery import LARGEST, ON_STRIP, sentences, small_poster, strip, unlike
from render.report.facts import facts
from render.report.written import speed
from shared.contract import Action, ForceMotion, write_motion
from shared.stage.errors import UserError
from shared.stage.paths import Out, mechanism_names
from shared.stage.stages import Stage, key_of
from tools.models.motions import bouncing_ball, four_bar_motion


def noise(path: Path, size: tuple[int, int]) -> None:
    """Return noise, the worst case of a JPEG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(np.random.default_rng(1).integers(0, 255, (size[1], size[0], 3), dtype=np.uint8)).save(path)


def test_a_poster_is_small_whatever_it_shows(tmp_path: Path) -> None:
    noise(tmp_path / "noise.png", (1280, 720))
    content = small_poster(tmp_path / "noise.png")
    assert len(content) <= LARGEST
    Image.new("RGB", (1280, 720), (30, 40, 50)).save(tmp_path / "plain.png")
    (tmp_path / "plain.jpg").write_bytes(small_poster(tmp_path / "plain.png"))
    with Image.open(tmp_path / "plain.jpg") as picture:
        assert picture.size == (960, 540)


@pytest.mark.parametrize(("count", "size"), [(1, (1280, 180)), (4, (1280, 180)), (6, (1280, 360))])
def test_all_posters_in_one(count: int, size: tuple[int, int]) -> None:
    posters = []
    for k in range(count):
        buffer = io.BytesIO()
        Image.new("RGB", (960, 540), (40 * k, 90, 200)).save(buffer, format="JPEG", quality=95)
        posters.append(buffer.getvalue())
    with Image.open(io.BytesIO(strip(posters))) as sheet:
        assert sheet.size == size
        last = sheet.getpixel((640 + 20, size[1] - 90))  # the middle of the last row is always filled
    assert isinstance(last, tuple)
    assert min(abs(last[0] - 40 * k) for k in range(count)) < 6


def plain(red: float) -> bytes:
    """A poster of one colour."""
    buffer = io.BytesIO()
    Image.new("RGB", (960, 540), (int(red), 90, 200)).save(buffer, format="JPEG", quality=95)
    return buffer.getvalue()


def test_the_strip_has_the_least_similar_posters() -> None:
    reds = [*range(20), 60, *(70 + 14 * k for k in range(12))]  # the first twenty are hardly to be told apart
    with Image.open(io.BytesIO(strip([plain(red) for red in reds]))) as sheet:
        assert sheet.size == (1280, 720)
        shown = np.asarray(sheet, int)[90::180, 160::320, 0].ravel()
    assert (np.diff(shown) > -3).all()  # in their order
    assert sum(value < 40 for value in shown) == 3
    assert {min(reds, key=lambda red: abs(red - value)) for value in shown} >= set(reds[20:])


def test_a_picture_that_is_there_twice_is_taken_once() -> None:
    looks = [np.full((2, 2), float(k // 2)) for k in range(2 * ON_STRIP)]
    taken = unlike(looks)
    assert [k // 2 for k in taken] == list(range(ON_STRIP))
    assert unlike(looks[:5]) == [0, 1, 2, 3, 4]


@pytest.mark.parametrize(
    ("docstring", "said"),
    [
        ("A crank. SI units.", "A crank."),
        ("A crank turns\na wheel. It is 5.4 m large. And more.\n\nRest.", "A crank turns a wheel. It is 5.4 m large."),
        ("", ""),
    ],
)  # fmt: skip
def test_two_sentences(docstring: str, said: str) -> None:
    assert sentences(docstring) == said


def test_facts_are_those_of_the_motion() -> None:
    motion = four_bar_motion()
    said, fastest = facts(motion, None, None), 0.090 * float(np.abs(motion.bodies["rocker"].omega).max())
    assert said[:3] == ["1 degree of freedom", "repeats after 1 s", f"C reaches {speed(fastest)}"]
    assert "motor up to 54 mN·m" in said
    assert "transmission angle from 41.8°" in said
    assert facts(bouncing_ball(), None, None)[1:3] == ["0.903 s of motion", "ball reaches 4.43 m/s (15.9 km/h)"]


def test_where_no_driver_works_facts_tell_the_force_that_does() -> None:
    motion = four_bar_motion()
    idle = msgspec.structs.replace(motion.drivers["motor"], effort=[0.0] * 361, power=[0.0] * 361)
    zeros = [0.0] * 361
    action = Action(body="crank", x=zeros, y=zeros, fx=zeros, fy=zeros, torque=[0.02] * 361)
    torque = ForceMotion(
        kind="torque", actions=[action], several=False, measures="angle", value=None, rate=None, effort=[0.02] * 361,
        normal=None, power=[0.1] * 361, potential=zeros, shape=None, effort_unit="N m", drives=True,
    )  # fmt: skip
    load = msgspec.structs.replace(torque, effort=[-0.5] * 361, power=[-1.0] * 361)
    driven = msgspec.structs.replace(motion, drivers={"wish": idle}, forces={"load": load, "hand": torque})
    said = facts(driven, None, None)
    assert "hand up to 20 mN·m" in said
    assert not [fact for fact in said if "load" in fact or "wish" in fact]


def test_the_page_shows_who_has_a_poster(
    out_root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "gallery"
    with pytest.raises(UserError, match="no mechanism has a poster"):
        gallery.run(folder)
    assert "four_bar is left out: it has no poster; make poster-four-bar" in capsys.readouterr().err
    out = Out("four_bar")
    write_motion(out.motion, four_bar_motion())
    noise(out.poster, (640, 360))
    folder.mkdir()
    with pytest.raises(UserError, match="no mechanism has a poster"):
        gallery.run(folder)
    assert "its poster is of an older version: no stage has recorded what it was made of" in capsys.readouterr().err
    Stage(out, "poster", key_of(out.motion), [out.poster]).record()
    with pytest.raises(UserError, match="no mechanism has a poster"):
        gallery.run(folder)
    assert "the machine has changed since it was solved" in capsys.readouterr().err, "it was not solved at all"
    monkeypatch.setattr(freshness, "current_names", set)
    (folder / "gone.jpg").touch()
    assert gallery.run(folder) == int(len(mechanism_names()) > 1)
    assert {path.name for path in folder.iterdir()} == {"README.md", "four_bar.jpg", "strip.jpg"}
    text = (folder / "README.md").read_text()
    assert "## Four bar\n![Four bar](four_bar.jpg)\\\nFour-bar crank-rocker A-B-C-D: the crank turns" in text
    assert "1 degree of freedom · repeats after 1 s ·" in text
    assert "SI units" not in text
    out.motion.write_bytes(out.motion.read_bytes() + b"\n")
    with pytest.raises(UserError, match="no mechanism has a poster"):
        gallery.run(folder)
    assert "its poster is of an older version: it is of an older data.json; make poster" in capsys.readouterr().err
