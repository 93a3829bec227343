"""Looks by name and by machine; presets in every aspect."""

from __future__ import annotations

import importlib
from collections import Counter
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from render.blender.scene.pieces import sunk
from render.blender.worker.picture import drawn
from render.film.inputs import named
from render.looks import LOOKS, Family, chosen
from render.presets import ASPECTS, PRESETS, preset_named
from render.view.solid import looks_of
from shared.contract.parts import Kind, mounted
from shared.contract.shot import LookName
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out, planar_names

MOST = 1 / 3
"""Part of the gallery that may have one look."""


def test_each_name_has_its_look_and_no_other():
    assert tuple(LOOKS) == get_args(LookName)
    assert all(look.name == name for name, look in LOOKS.items())


@pytest.mark.parametrize("name", LOOKS)
def test_a_look_has_light_or_is_drawn_and_its_page_follows_the_theme(name: str):
    look = LOOKS[name]
    for light in (look.lying, look.standing):
        assert look.drawing is not None or light.softboxes
    for stands in (False, True):
        shown = looks_of(look, stands)
        assert shown["dark" if look.dark else "light"]["name"] == name
        if look.other is not None:
            assert shown["dark"]["dark"]
            assert not shown["light"]["dark"]


@pytest.mark.parametrize(
    ("mount", "engine", "driven", "size", "look"),
    [
        ("ground", False, True, 2.0, "road"),
        ("ground", False, False, 0.06, "bench"),
        ("stand", False, True, 6.0, "road"),
        ("stand", True, True, 0.3, "studio"),
        ("stand", False, False, 0.3, "cyclorama"),
        ("desk", False, False, 0.3, "cyclorama"),
        ("desk", False, True, 0.2, "studio"),
        ("stand", False, True, 0.2, "bench"),
        ("stand", False, True, 1.5, "daylight"),
        ("wall", False, True, 0.2, "daylight"),
    ],
)
def test_facts_of_the_files_choose_the_look(mount: Kind, engine: bool, driven: bool, size: float, look: str):
    assert chosen(Family(mount, engine, driven, size)) == look


def test_no_look_has_more_than_a_third_of_the_gallery():
    looks: Counter[str] = Counter()
    names = planar_names()
    for name in names:
        looks.update(_possible(name))
    assert len(looks) == len(LOOKS)
    assert max(looks.values()) <= MOST * len(names), looks


def _possible(name: str) -> set[str]:
    """The looks that a mechanism can have: its shot.py's, or what its model chooses on a desk and in a room."""
    shot = None
    if (ROOT / "mechanisms" / name / "shot.py").is_file():
        shot = importlib.import_module(f"mechanisms.{name}.shot").shot
        if shot.look is not None:
            return {shot.look}
    module = importlib.import_module(f"mechanisms.{name}.mechanism")
    m = module.build(module.Params())
    mount = mounted(m.gravity or (0.0, 0.0), shot.mount if shot else None)
    engine = any("gas" in type(force).__name__.lower() for force in m.forces.values())
    return {chosen(Family(mount.kind, engine, bool(m.drivers), size)) for size in (0.1, 1.0)}


def test_posters_have_more_samples_than_the_film_of_their_preset():
    for preset in PRESETS.values():
        assert preset.of_poster.samples >= max(4 * 4, preset.samples)
        assert (preset.of_poster.width, preset.of_poster.height) == (preset.width, preset.height)
    assert all(PRESETS[name].of_poster.samples == 128 for name in ("preview", "production", "final"))


def codes(number: np.ndarray, times: int = 2) -> np.ndarray:
    """Codes of solids by number that all face the camera, at a distance of one radius."""
    large = number.repeat(times, axis=0).repeat(times, axis=1)
    return np.stack([large + 0.25, np.full(large.shape, 0.5), np.ones(large.shape)], axis=-1)


@given(st.integers(1, 40), st.integers(41, 90))
def test_a_drawing_has_lines_where_solids_meet_and_nowhere_else(first: int, second: int):
    number = np.full((72, 128), first)
    number[:, 64:] = second
    drawing = LOOKS["blueprint"].drawing
    assert drawing is not None
    picture = drawn(codes(number), drawing, 128, 72)
    bright = picture[36].sum(axis=-1)
    assert bright[63:65].max() > bright[:60].max() + 0.5
    assert np.ptp(picture[10:60, 10:55], axis=(0, 1)).max() < 1e-6
    whole = drawn(codes(np.full((72, 128), first)), drawing, 128, 72)
    assert np.ptp(whole, axis=(0, 1)).max() < 1e-6


def test_paper_without_solids_is_squared_and_has_a_frame():
    drawing = LOOKS["blueprint"].drawing
    assert drawing is not None
    paper = drawn(np.zeros((360, 640, 3)), drawing, 640, 360)
    assert abs(paper[5:300, 5:300].mean(axis=(0, 1)) - drawing.paper).max() < 0.05
    assert paper.max() > 0.5


def test_only_what_is_cut_a_little_into_the_upper_face_is_filled():
    def face(heights: tuple[float, float, float], up: float, area: float) -> tuple:
        return [h / 1000 for h in heights], up, area

    faces = [
        face((10, 10, 10), 1.0, 500.0),  # the upper face
        face((9.6, 9.6, 9.6), 1.0, 3.0),  # the floor of a letter
        face((10, 9.6, 9.6), 0.0, 1.0),  # its wall
        face((7, 7, 7), 1.0, 80.0),  # a pocket
        face((10, 7, 7), 0.0, 20.0),  # its wall
        face((10, 9.6, 10), 0.7, 9.0),  # a chamfer
        face((0, 0, 10), 0.0, 60.0),  # the rim
        face((0, 0, 0), -1.0, 500.0),  # the back
    ]
    heights, up, areas = (np.array(part) for part in zip(*faces, strict=True))
    assert sunk(heights, up, areas).tolist() == [False, True, True, False, False, False, False, False]
    assert not sunk(heights[[0, 3, 4, 6, 7]], up[[0, 3, 4, 6, 7]], areas[[0, 3, 4, 6, 7]]).any()
    assert not sunk(heights[[6]], up[[6]], areas[[6]]).any()


def test_pictures_have_the_usual_pixels_of_their_shape() -> None:
    sizes = {aspect: PRESETS["production"].framed(aspect) for aspect in ASPECTS}
    assert {aspect: (p.width, p.height) for aspect, p in sizes.items()} == {
        "16:9": (1920, 1080), "1:1": (1080, 1080), "4:5": (1080, 1350), "9:16": (1080, 1920),
    }  # fmt: skip
    for preset in PRESETS.values():
        for aspect, (wide, high) in ASPECTS.items():
            made = preset.framed(aspect)
            assert made.width * high == made.height * wide
            assert made.width % 2 == made.height % 2 == 0  # H.264 with 4:2:0 takes no others
            assert min(made.width, made.height) == preset.height
            assert (made.samples, made.motion_blur) == (preset.samples, preset.motion_blur)
            assert preset_named(made.name) == preset_named(preset.name, aspect) == made


def test_no_two_shapes_share_a_file(out_root: str) -> None:
    out = Out("four_bar")
    made = [PRESETS["preview"].framed(aspect) for aspect in ASPECTS]
    for paths in (
        [out.film(preset.name) for preset in made],
        [out.frames(preset.name) for preset in made],
        [named(out.poster, "forces", preset.suffix) for preset in made],
        [named(out.contact, "", preset.suffix) for preset in made],
    ):
        assert len(set(paths)) == len(made)
    assert named(out.poster, "", made[0].suffix) == out.poster
    assert named(out.poster, "forces", made[-1].suffix).name == "poster-9x16-forces.png"
    assert made[-1].request == "PRESET=preview ASPECT=9:16"
    assert made[0].request == "PRESET=preview"


@pytest.mark.parametrize("aspect", ["3:2", "16/9", "9:16:1", "x"])
def test_an_unknown_aspect_is_refused_with_the_known_ones(aspect: str) -> None:
    with pytest.raises(UserError, match=f"there is no ASPECT={aspect}; there is: 16:9, 1:1, 4:5, 9:16"):
        preset_named("preview", aspect)
    with pytest.raises(UserError, match="there is no preset 'big'"):
        preset_named("big", "9:16")
