"""Presets in every aspect: their pixels, the names of their files, and what is refused."""

from __future__ import annotations

import pytest

from render.film.inputs import named
from render.presets import ASPECTS, PRESETS, preset_named
from shared.stage.errors import UserError
from shared.stage.paths import Out


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
