"""Words over the pictures of a film: titles, live numbers, legends; and the room that they need."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageFilter

from render.blender.worker import words
from render.film import arrows, composing
from render.film.clock import Clock
from render.film.framing import axes, half_field, project
from render.film.inputs import read_film
from render.film.scene import ARC, LegendRow, Writing
from render.letters import width_of
from render.presets import ASPECT, ASPECTS
from shared.contract.shot import Camera, Names, Shot, Title, refuse_unknown
from shared.contract.signals import SIGNALS, rgb
from shared.stage.errors import UserError
from tools.fixtures import film_fixture
from tools.models.motions import bouncing_ball, four_bar_motion

FORCE = rgb(SIGNALS["forces"].dark)


def test_titles_and_numbers_that_live():
    motion = four_bar_motion()
    shot = Shot(title=Title(), seconds_per_turn=4.0)
    assert arrows.title(motion, shot) == "Four bar"
    assert arrows.rate(Clock(motion, shot), shot) == "4 times slower"
    assert arrows.rate(Clock(motion, Shot(seconds_per_turn=4.0)), Shot()) == ""
    effort = motion.drivers["motor"].effort
    said = arrows.number(motion, shot)(motion.time[90])
    assert said.startswith("motor  ")
    assert float(said.split()[1].replace("−", "-")) == pytest.approx(1000 * effort[90], abs=0.051)
    assert said.endswith(" mN·m")
    point, at = motion.points["P"], motion.time[33]
    speed = float(np.hypot(point.vx[33], point.vy[33]))
    words = arrows.number(motion, Shot(title=Title(number="P")))(at).split()
    assert words[2:] == ["mm/s"]
    assert float(words[1]) == pytest.approx(1000 * speed, abs=1)
    assert arrows.number(motion, Shot())(0.0) == ""
    with pytest.raises(UserError, match="motor"):
        refuse_unknown(Shot(title=Title(number="moto")), Names("four_bar", (), ("P",), {}, ("motor",)))


def test_the_legend_keeps_clear_of_what_moves_and_then_of_what_stands(out_root: Path):
    film = read_film(film_fixture.write(Shot(seconds_per_turn=0.4)))
    camera, none = film.camera(0), np.zeros((0, 3))
    across, up = half_field(camera.lens)

    def seen_at(x: float, y: float) -> np.ndarray:
        """A point that is at these parts of the picture."""
        sight = np.array([(2 * x - 1) * across, (1 - 2 * y) * up, 1.0])
        return np.array([camera.position]) + sight @ axes(camera.azimuth, camera.elevation)

    left, right = seen_at(0.1, 0.9), seen_at(0.9, 0.9)
    assert project(camera, right, 100, 100 * 9 / 16)[0] == pytest.approx([90, 90 * 9 / 16])
    empty = composing.box_of([])
    small = composing.cards([LegendRow(number="5 N", words="forces", colour=(0, 0, 0), length=0.1)], empty, ASPECT)
    places = {corner: composing.in_picture(composing.around(card), ASPECT) for corner, card in small.items()}

    def chosen(moving: np.ndarray, standing: np.ndarray) -> str:
        return composing.emptiest([camera], moving, standing, places)

    assert chosen(none, none) == "lower left"
    assert chosen(left, none) == "lower right"
    assert chosen(np.concatenate([left, right]), none) == "upper right"
    assert chosen(none, left) == "lower right"
    assert chosen(left, np.tile(right, (9, 1))) == "upper right"
    assert len(film.space.standing) > 100


def test_the_rate_of_a_simulation_that_is_not_in_real_time_is_always_told():
    motion = bouncing_ball()
    slow = Shot(rate=0.05)
    assert arrows.rate(Clock(motion, slow), slow) == "20 times slower"
    assert arrows.rate(Clock(motion, Shot(rate=1.0)), Shot(rate=1.0)) == ""


def test_the_overlay_writes_its_legend_onto_its_card_alone(tmp_path: Path):
    path = tmp_path / "p.png"
    Image.new("RGB", (320, 180), (40, 40, 40)).save(path)
    before = path.read_bytes()
    words.lay(path, None, Writing(), "")
    assert path.read_bytes() == before
    row = LegendRow(number="5 N", words="forces", colour=FORCE, length=0.1, point=0.03)
    card = composing.cards([row], composing.box_of([]), ASPECT)["lower right"]
    words.lay(path, None, Writing(legend=[row], card=card), "")
    pixels = np.asarray(Image.open(path)).astype(int)
    rows, columns = np.nonzero(np.abs(pixels - 40).sum(axis=2) > 6)
    assert rows.min() >= 180 * card.top - 1
    assert rows.max() <= 180 * (card.top + card.high) + 1
    assert columns.min() >= 180 * card.left - 1
    assert columns.max() <= 180 * (card.left + card.wide) + 1
    orange = np.abs(pixels - 255 * np.array(FORCE)).sum(axis=2) < 12
    assert 27 <= np.ptp(np.nonzero(orange)[1]) <= 34  # a tenth of the picture


WORDS = st.text("abcdefgh IlmW", min_size=1, max_size=60).map(str.strip).filter(bool)
ROWS = st.lists(
    st.builds(
        LegendRow,
        number=st.sampled_from(["5 N", "100 mN·m", "0.05 m/s"]),
        words=st.sampled_from(["forces", "torques of joints", "accelerations, peaks cut"]),
        colour=st.just((1.0, 0.5, 0.1)),
        length=st.floats(0.02, 0.33),
        sweep=st.sampled_from([0.0, 2.0]),
    ),
    max_size=6,
)


@given(st.sampled_from(list(ASPECTS.values())), WORDS, st.lists(WORDS, max_size=2), WORDS | st.just(""), ROWS)
def test_words_and_legend_neither_overlap_nor_leave_a_picture_of_any_shape(
    shape: tuple[int, int], title: str, numbers: list[str], rate: str, rows: list[LegendRow]
):
    aspect = shape[0] / shape[1]
    wide, high = composing.sides(aspect)
    lines = composing.lines(title, numbers, rate, aspect)
    below = 0.0
    for line in lines:
        words = [line.words] if line.words else numbers
        assert all(line.x + line.size * width_of(word, line.bold) <= wide - composing.EDGE + 1e-9 for word in words)
        assert line.y >= below
        below = line.y + 1.2 * line.size
    assert below <= high / 2
    assert " ".join(line.words for line in lines if line.bold) == title
    for card in composing.cards(rows, composing.box_of(lines), aspect).values():
        right, lower = card.left + card.wide, card.top + card.high
        assert card.left >= composing.EDGE / 2
        assert right <= wide - composing.EDGE / 2
        assert card.top >= composing.EDGE / 2
        assert lower <= high - composing.EDGE / 2
        for line in lines:
            assert card.left >= line.x + line.width or card.top >= line.y + line.size
        for row in rows:
            arrow = 2.6 * ARC * card.size if row.sweep else row.length * wide
            assert arrow <= card.arrows - card.pad + 1e-9
            assert card.numbers + card.size * width_of(row.number) <= card.words
            assert card.words + card.size * width_of(row.words) <= card.wide
        assert card.row >= 1.2 * card.size


def contrast(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return the contrast of WCAG 2.2 between sRGB colours (..., 3), 0..255."""

    def luminance(colour: np.ndarray) -> np.ndarray:
        part = np.asarray(colour) / 255
        linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
        return linear @ [0.2126, 0.7152, 0.0722]

    pair = np.broadcast_arrays(luminance(first), luminance(second))
    low, high = np.sort(pair, axis=0)
    return (high + 0.05) / (low + 0.05)


BEHIND = [(0, 0, 0), (255, 255, 255), (128, 128, 128), (255, 142, 62), (60, 120, 230)]
"""Colours that may be behind words: the darkest, the brightest, two between, a trail, an anodised part."""


@pytest.mark.parametrize("behind", BEHIND)
@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("shape", [(1920, 1080), (1080, 1920)])
def test_words_have_a_contrast_of_four_and_a_half_to_whatever_is_behind_them(
    behind: tuple[int, int, int], dark: bool, shape: tuple[int, int]
):
    """Measured where a letter hides nothing any more: three pixels beside those that have its ink alone."""
    number = "motor  −0.0143 N·m"
    lines = composing.lines("Four bar", [number], "4 times slower", shape[0] / shape[1])
    page = Image.new("RGB", shape, behind)
    words.lay_words(page, Writing(lines=lines, on_bright=dark), number)
    pixels = np.asarray(page).astype(int)
    for line in lines:
        ink = np.array((words.DARK if dark else words.BRIGHT)[line.quiet])
        top, bottom = round(1080 * line.y), round(1080 * (line.y + 1.35 * line.size))
        rows = pixels[max(top - 4, 0) : bottom + 4]
        mine = np.zeros(rows.shape[:2], bool)
        mine[min(top, 4) : min(top, 4) + bottom - top] = True
        letters = Image.fromarray((255 * ((np.abs(rows - ink).max(axis=2) < 2) & mine)).astype(np.uint8))
        near, farther = (np.asarray(letters.filter(ImageFilter.MaxFilter(size))) > 0 for size in (5, 7))
        ratios = contrast(rows[farther & ~near], ink)
        assert len(ratios) > 500
        assert np.quantile(ratios, 0.01) >= 4.5, line


@pytest.mark.parametrize("behind", BEHIND)
def test_words_of_a_legend_have_that_contrast_to_its_card(behind: tuple[int, int, int]):
    card = np.array(words.CARD[:3]) + (np.array(behind) - words.CARD[:3]) * (1 - words.CARD[3] / 255)
    for ink in (words.INK, words.QUIET):
        assert contrast(card, np.array(ink[:3])) >= 4.5


def test_a_title_makes_room_for_itself_and_nothing_moves_under_it(out_root: Path):
    for elevation, in_the_way in ((30.0, True), (89.0, False)):
        close = Camera(elevation=elevation, margin=0.01)
        out = film_fixture.write(Shot(seconds_per_turn=0.4, camera=close))
        film, plain = read_film(out, "velocities,title"), read_film(out, "velocities")
        arrows, moving = film.scene.writing, film._seen_moving
        title = composing.in_picture(composing.box_of(arrows.lines), ASPECT)
        assert arrows.lines[0].words == "Four bar"
        assert (composing.count_held(plain.camera(0), moving, title) > 0) == in_the_way
        assert composing.count_held(film.camera(0), moving, title) == 0
        assert arrows.card is not None
        legend = composing.in_picture(composing.around(arrows.card), ASPECT)
        assert composing.count_held(film.camera(0), moving, legend) == 0
        if in_the_way:
            assert film.camera(0) != plain.camera(0)
        pixels = project(film.camera(0), film.space.machine, 1600, 900)
        assert (pixels > -1e-6).all()
        assert (pixels < (1600 + 1e-6, 900 + 1e-6)).all()
