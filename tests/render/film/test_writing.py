"""What is written over the pictures of a film: titles, numbers that live, legends; and the room that they need."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from render.blender.worker import overlay
from render.film.arrows import writing
from render.film.arrows.arrows import COLOURS
from render.film.clock import Clock
from render.film.framing import axes, half_width, project
from render.film.inputs import read_film
from render.film.scene import LegendRow, Writing
from shared.contract.shot import Camera, Names, Shot, Title, refuse_unknown
from shared.stage.errors import UserError
from tests.models.motions import bouncing_ball, four_bar_motion
from tests.render import film_fixture


def test_titles_and_numbers_that_live():
    motion = four_bar_motion()
    shot = Shot(title=Title(), seconds_per_turn=4.0)
    assert writing.title(motion, shot) == "Four bar"
    assert writing.rate(Clock(motion, shot), shot) == "4 times slower"
    assert writing.rate(Clock(motion, Shot(seconds_per_turn=4.0)), Shot()) == ""
    effort = motion.drivers["motor"].effort
    said = writing.number(motion, shot)(motion.time[90])
    assert said.startswith("motor  ")
    assert float(said.split()[1].replace("−", "-")) == pytest.approx(effort[90], abs=5.1e-5)
    point, at = motion.points["P"], motion.time[33]
    speed = float(np.hypot(point.vx[33], point.vy[33]))
    words = writing.number(motion, Shot(title=Title(number="P")))(at).split()
    assert words[2] == "m/s"
    assert words[4] == "km/h"
    assert float(words[1]) == pytest.approx(speed, abs=1e-3)
    assert float(words[3]) == pytest.approx(3.6 * speed, abs=1e-2)
    assert writing.number(motion, Shot())(0.0) == ""
    with pytest.raises(UserError, match="motor"):
        refuse_unknown(Shot(title=Title(number="moto")), Names("four_bar", (), ("P",), {}, ("motor",)))


def test_the_legend_keeps_clear_of_what_moves_and_then_of_what_stands(out_root: Path):
    film = read_film(film_fixture.write(Shot(seconds_per_turn=0.4)))
    camera, none = film.camera(0), np.zeros((0, 3))
    wide = 2 * half_width(camera.lens)

    def seen_at(x: float, y: float) -> np.ndarray:
        """A point that is at these parts of the picture."""
        sight = np.array([(x - 0.5) * wide, (0.5 - y) * wide * 9 / 16, 1.0])
        return np.array([camera.position]) + sight @ axes(camera.azimuth, camera.elevation)

    left, right = seen_at(0.1, 0.9), seen_at(0.9, 0.9)
    assert project(camera, right, 100, 100 * 9 / 16)[0] == pytest.approx([90, 90 * 9 / 16])
    places = writing.card(
        [LegendRow(number="5 N", words="forces", colour=(0, 0, 0), length=0.1, point=0.0)], (0.0, 0.0)
    )
    assert writing.emptiest(camera, none, none, places) == "lower left"
    assert writing.emptiest(camera, left, none, places) == "lower right"
    assert writing.emptiest(camera, np.concatenate([left, right]), none, places) == "upper right"
    assert writing.emptiest(camera, none, left, places) == "lower right"
    assert writing.emptiest(camera, left, np.tile(right, (9, 1)), places) == "upper right"
    assert len(film.space.standing) > 100
    rows = 4 * [LegendRow(number="100 mN m", words="torques of joints", colour=(0, 0, 0), length=0.2, point=0.0)]
    large = writing.card(rows, (0.0, 0.0))
    assert large["lower left"][2] > places["lower left"][2]
    assert large["lower left"][1] < places["lower left"][1]
    assert "upper right" not in writing.card(rows, (0.6, 0.1))  # a title is there


def test_the_rate_of_a_simulation_that_is_not_in_real_time_is_always_told():
    motion = bouncing_ball()
    slow = Shot(rate=0.05)
    assert writing.rate(Clock(motion, slow), slow) == "20 times slower"
    assert writing.rate(Clock(motion, Shot(rate=1.0)), Shot(rate=1.0)) == ""


def test_the_overlay_writes_its_legend_into_its_corner_alone(tmp_path: Path):
    path = tmp_path / "p.png"
    Image.new("RGB", (320, 180), (40, 40, 40)).save(path)
    before = path.read_bytes()
    overlay.lay(path, None, Writing(), "")
    assert path.read_bytes() == before
    row = LegendRow(number="5 N", words="forces", colour=COLOURS["forces"], length=0.1, point=0.03)
    overlay.lay(path, None, Writing(legend=[row], corner="lower right"), "")
    changed = np.abs(np.asarray(Image.open(path)).astype(int) - 40).sum(axis=2) > 6
    rows, columns = np.nonzero(changed)
    assert changed.any()
    assert rows.min() > 120
    assert columns.min() > 130
    orange = np.abs(np.asarray(Image.open(path)) - 255 * np.array(COLOURS["forces"])).sum(axis=2) < 12
    assert 27 <= np.ptp(np.nonzero(orange)[1]) <= 34  # a tenth of the picture


def test_a_title_makes_room_for_itself_and_nothing_moves_under_it(out_root: Path):
    for elevation, in_the_way in ((30.0, True), (89.0, False)):
        close = Camera(elevation=elevation, margin=0.01)
        out = film_fixture.write(Shot(seconds_per_turn=0.4, camera=close))
        film, plain = read_film(out, "velocities,title"), read_film(out, "velocities")
        moving, title = film._seen_moving, (0.0, 0.0, *writing.extent(film._said))
        assert film.scene.writing.title == "Four bar"
        assert (writing.held(plain.camera(0), moving, title) > 0) == in_the_way
        assert writing.held(film.camera(0), moving, title) == 0
        legend = writing.card(film.scene.writing.legend, title[2:])[film.scene.writing.corner]
        assert writing.held(film.camera(0), moving, legend) == 0
        if in_the_way:
            assert film.camera(0) != plain.camera(0)
        pixels = project(film.camera(0), film.space.all, 1600, 900)
        assert (pixels > -1e-6).all()
        assert (pixels < (1600 + 1e-6, 900 + 1e-6)).all()
