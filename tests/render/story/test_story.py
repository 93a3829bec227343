"""A story from files alone: its shots, their times, what they cost, and what is refused, without Blender."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from render.film.film import Film
from render.film.framing import project
from render.film.story.planned import planned, scenery_of
from render.film.story.ramps import Ramp, into, stepped, warped
from render.film.story.shots import close_ups, reason
from render.film.story.story import Story, curves_of
from render.frames.story import kinds
from render.frames.story.telling import Telling, telling_of
from render.insights import Insight
from render.insights.meeting import happening
from render.insights.seen import insight
from render.insights.stops import stops
from render.presets import PRESETS, preset_named
from shared.contract.shot import STORY_SHOTS, Camera, Section, Shot
from shared.contract.shot import Story as Wishes
from shared.stage.errors import UserError
from tools.fixtures import film_fixture


def tell(wishes: Wishes | None = None, preset: str = "draft", loop: float = 0.0, **shot) -> Telling:
    out = film_fixture.write(Shot(story=wishes or Wishes(), **shot))
    return telling_of(out, preset_named(preset), "", loop)


def _bell(at: float) -> Insight:
    return insight("event", 0.0, "", (at, at), 0.0, joints=("bell",), name="bell", what="rings")


def check(telling: Telling) -> Story:
    """Check a story: time is monotone within a shot, with the rate that is written over the picture."""
    story = telling.story
    for placed in story.placed:
        seconds = np.arange(placed.end - placed.first) / story.fps
        times = [placed.shot.model(float(s)) for s in seconds]
        assert np.all(np.diff(times) >= -1e-12) or not telling.film.clock.repeats
    ends = [row[:2] for row in story.chapters]
    assert ends[0][0] == 0.0
    assert ends[-1][1] == pytest.approx(story.seconds)
    assert all(a[1] == b[0] for a, b in itertools.pairwise(ends))
    assert all(0 <= c.start < c.end <= story.seconds + 1e-9 and c.text for c in story.captions)
    top = telling.film.space.all[:, 2].max()
    lifted = max((lift.distance for lift in _lifts(telling)), default=0.0)
    for picture in story.pictures:
        assert picture.camera.position[2] > top + (lifted if picture.lifts else 0.0)  # it never goes through a part
    return story


def _lifts(telling: Telling):
    from render.film.pieces import exploded

    return exploded(telling.film.parts, telling.film.size)


def test_it_has_all_shots_and_costs_little_more_than_the_loop(out_root) -> None:
    telling = tell()
    story = check(telling)
    assert [placed.shot.name for placed in story.placed] == [name for name in STORY_SHOTS if name != "section"]
    assert 20 <= story.seconds <= 40
    assert story.step == 2
    assert len(story.pictures) <= 2.5 * telling.film.clock.frames
    assert tell(preset="final").story.step == 1


def test_time_stops_at_the_dead_point_and_says_so(out_root) -> None:
    telling = tell(Wishes(event="rocker turns back"))
    story = telling.story
    placed = next(placed for placed in story.placed if placed.shot.name == "reason")
    caption = placed.shot.captions[0]
    assert caption.text.startswith("The rocker turns back at 34° and 229°, where the crank and the coupler are in line")
    middle = (caption.start + caption.end) / 2 + placed.first / story.fps
    frame = int(middle * story.fps)
    assert story.over(frame).rate == "time stands still"
    assert story.picture(frame) == story.picture(frame + 10)
    assert story.picture(frame).grown == 1.0
    rocker = telling.film.motion.bodies["rocker"]
    at = (story.model_time(middle) - rocker_time(telling)) % period_of(telling)
    omega = np.interp(at + rocker_time(telling), telling.film.motion.time, rocker.omega)
    assert abs(omega) < 1e-3 * np.abs(rocker.omega).max()


def test_the_close_up_has_its_event_after_three_fifths_of_its_move(out_root) -> None:
    telling = tell()
    placed = next(placed for placed in telling.story.placed if placed.shot.name == "macro")
    motion = telling.film.motion
    events = [motion.time[int(happening(motion, name).argmax())] for name in motion.joints]
    seconds = np.linspace(0.0, placed.shot.seconds, 20001)
    times = np.array([placed.shot.model(float(s)) for s in seconds])
    move = seconds[int(np.argmax(times >= times[-1] - 1e-12))]
    shown = placed.shot.model(close_ups.EVENT * float(move))
    off = [abs((shown - at + period_of(telling) / 2) % period_of(telling) - period_of(telling) / 2) for at in events]
    assert min(off) < 1e-4


def test_sound_follows_the_times_of_the_story(out_root) -> None:
    telling = tell()
    story, clock = telling.story, telling.film.clock
    heard = story.time_map(clock.start, clock.end)
    assert heard.seconds == pytest.approx(story.seconds)
    seconds = (np.arange(story.total - 1) + 0.3) / story.fps
    moments, rates = heard.moments_at(seconds)
    exact = np.array([story.model_time(float(s)) for s in seconds])
    period = clock.end - clock.start
    off = (moments - exact + period / 2) % period - period / 2
    assert np.abs(off).max() < 0.02 * period / story.fps, "straight between frames"
    assert moments.min() >= clock.start - 1e-9
    assert moments.max() <= clock.end + 1e-9
    assert np.all(rates >= -1e-9)
    still = [k for k in range(story.total - 1) if story.over(k).rate == "time stands still"]
    assert still
    assert np.abs(rates[still[2:-2]]).max() < 1e-9


def test_sound_of_a_motion_that_ends_stands_where_the_picture_does(out_root) -> None:
    """Also past the end, where what follows an event would go beyond it: there the picture is held."""
    telling = tell()
    motion = telling.film.motion
    motion.period = None
    film = Film(motion, telling.film.parts, telling.film.shot, telling.film.folder, 16 / 9)
    at = motion.time[-1] - 0.01 * (motion.time[-1] - motion.time[0])
    story = planned(film, None, [_bell(at)], PRESETS["draft"])
    heard = story.time_map(film.clock.start, film.clock.end, anew=False)
    seconds = (np.arange(story.total) + 0.5) / story.fps
    shown = np.array([min(max(story.model_time(float(s)), film.clock.start), film.clock.end) for s in seconds])
    moments, rates = heard.moments_at(seconds)
    anew = np.abs(moments - shown) > 0.1 * (film.clock.end - film.clock.start)
    assert anew.sum() <= 3, "frames in which the motion begins anew"
    assert np.abs(moments - shown)[~anew].max() < film.clock.rate / story.fps
    assert np.all(rates >= 0)
    (reason,) = (placed for placed in story.placed if placed.shot.name == "reason")
    assert moments[reason.end - 2] == pytest.approx(film.clock.end)


def period_of(telling: Telling) -> float:
    period = telling.film.motion.period
    assert period is not None
    return period


def rocker_time(telling: Telling) -> float:
    return telling.film.motion.time[0]


def test_words_and_numbers_of_the_picture_agree_with_its_time(out_root) -> None:
    """The rate that is written is the slope of the time of the motion; the playhead stands where the picture is."""
    telling = tell()
    story = telling.story
    placed = next(placed for placed in story.placed if placed.shot.name == "motion")
    frame = placed.first + 40
    slope = story.model_time((frame + 2) / story.fps) - story.model_time(frame / story.fps)
    assert slope * story.fps / 2 == pytest.approx(telling.film.clock.rate)
    assert telling.film.clock.moment(story.picture(frame).at).time == pytest.approx(
        (story.over(frame).now - rocker_time(telling)) % period_of(telling) + rocker_time(telling)
    )


def test_an_assembly_comes_together_as_it_came_apart(out_root) -> None:
    """So that it costs half: every picture of the way back is one of the way out."""
    story = tell().story
    placed = next(placed for placed in story.placed if placed.shot.name == "assembly")
    pictures = [story.picture(frame) for frame in range(placed.first, placed.end)]
    middle = len(pictures) // 2
    assert pictures[0].lifts == pictures[-1].lifts == ()
    assert set(pictures[middle:]) <= set(pictures[:middle])
    assert {name for name, _ in pictures[middle].lifts} == {lift.name for lift in _lifts(tell()) if lift.distance}
    names = [leader.words for leader in story.over(placed.first + middle).leaders]
    assert sorted(names) == ["coupler", "crank", "frame", "rocker"]


def test_all_pieces_are_in_the_picture_while_they_come_apart(out_root) -> None:
    telling = tell(camera=Camera(lens=90.0))
    film, preset = telling.film, PRESETS["draft"]
    scenery = scenery_of(film, telling.forces, stops(film.motion), preset)
    (placed,) = (each for each in telling.story.placed if each.shot.name == "assembly")
    for frame in range(placed.first, placed.end, telling.story.step):
        picture = telling.story.picture(frame)
        heights = dict(picture.lifts)
        for lift in scenery.lifts:
            corners = scenery.piece(lift, heights.get(lift.name, 0.0) / (lift.distance or 1.0))
            places = project(picture.camera, corners, film.aspect, 1.0) / np.array([film.aspect, 1.0])
            assert 0.0 <= places.min() <= places.max() <= 1.0, (frame - placed.first, lift.name)


def test_a_shot_with_a_section_has_a_shot_of_it(out_root) -> None:
    telling = tell(section=Section(right=0.5), preset="final")
    story, cut = check(telling), telling.cut
    assert [placed.shot.name for placed in story.placed] == list(STORY_SHOTS)
    (placed,) = (each for each in story.placed if each.shot.name == "section")
    for frame in range(story.total):
        assert story.picture(frame).cut == (placed.first <= frame < placed.end)
        if story.picture(frame).cut:
            assert 19 < np.degrees(story.picture(frame).camera.azimuth) < 41, "its face looks to the right"
    assert cut is not None
    assert any(piece.cut for piece in cut.scene.pieces)
    assert not any(piece.cut for piece in telling.film.scene.pieces)
    sets = telling.pictures(PRESETS["final"])
    assert [pictures.film for pictures in sets] == [telling.film, cut, telling.forces]
    assert sum(len(pictures.rows) for pictures in sets) == len(
        {telling.row(k, PRESETS["final"]) for k in range(story.total)}
    )
    with pytest.raises(UserError, match=r"shots has a section, and shot\.section cuts nothing open"):
        tell(Wishes(shots=("section", "last")))
    with pytest.raises(UserError, match=r"shot\.section = front=0\.5 cuts no piece open"):
        tell(section=Section(front=0.5, only=("ground/base", "coupler/coupler")))


def test_the_reason_for_the_stop_comes_before_the_most_loaded_joint(out_root) -> None:
    motion = tell().film.motion
    both = [insight("reaction", 1.0, "N", (at, at), 0.0, joints=(joint,)) for at, joint in ((0.5, "C"), (0.1, "B"))]
    named = [curve.name for curve in curves_of(motion, None, both)]
    assert named[0] == "C", "B has the same unit"
    assert "B" not in named


def test_a_shot_says_otherwise_in_a_few_lines(out_root) -> None:
    story = tell(Wishes(shots=("motion", "reason"), event="B", caption="Look here", curves=("P",), language="de")).story
    assert [placed.shot.chapter for placed in story.placed] == ["Bewegung", "Warum"]
    assert story.captions[-1].text == "Look here"
    assert [curve.name for curve in story.curves] == ["P"]
    assert tell(Wishes(curves=())).drawing.strip is None


@pytest.mark.parametrize(
    ("wishes", "message"),
    [
        (Wishes(event="rocker flies"), r"four_bar: shot\.story\.event names 'rocker flies', which never happens in "
         r"this motion; its events are: .*rocker turns back.*"),
        (Wishes(caption="much too long a word " * 9), r"four_bar: the caption of the shot 'reason' is too long for a "
         r"picture of 640x360: it takes \d\.\d lines of 2 .*; write a shorter shot\.story\.caption"),
        (Wishes(shots=("titel",)), r"four_bar: shot\.story\.shots\[0\] names 'titel', which does not exist; known: "
         r"title, assembly, .*; did you mean 'title'\?"),
        (Wishes(shots=("title", "motion"), caption="Look"), r"four_bar: shot\.story\.caption is for the shot "
         r"'reason', which shot\.story\.shots leaves out; add 'reason'"),
        (Wishes(shots=("motion", "reason"), joint="B"), r"shot\.story\.joint is for the shot 'macro', .*; add 'macro'"),
        (Wishes(shots=("title",)), r"title leaves nothing to show: .* a title stands before another shot; "
         r"add motion or last"),
        (Wishes(joint="Z"), r"four_bar: shot\.story\.joint names 'Z', which does not exist; known: A, B, C, D"),
        (Wishes(language="xx"), r"language is 'xx'"),
    ],
)  # fmt: skip
def test_invalid_stories_are_refused_with_place_and_remedy(out_root, wishes: Wishes, message: str) -> None:
    with pytest.raises(UserError, match=message):
        tell(wishes)


def test_kinds_of_films_are_known(out_root) -> None:
    with pytest.raises(UserError, match=r"there is no STORY=explian; .*, explain, compare; did you mean 'explain'"):
        kinds.run("four_bar", PRESETS["draft"], story="explian")
    with pytest.raises(UserError, match="LOOP=2 is no length of a loop; give 4 to 60 s"):
        kinds.run("four_bar", PRESETS["draft"], story="explain", loop=2.0)
    with pytest.raises(UserError, match="STORY=compare has no LOOP"):
        kinds.run("four_bar", PRESETS["draft"], story="compare", loop=9.0)


@pytest.mark.parametrize("seconds", [4.0, 12.0, 33.3])
def test_a_loop_ends_as_it_begins(out_root, seconds: float) -> None:
    telling = tell(loop=seconds, preset="draft-9x16")
    story = check(telling)
    assert story.total == round(seconds * story.fps)
    turns = (story.shots[0].model(seconds) - story.shots[0].model(0.0)) / period_of(telling)
    assert turns == pytest.approx(round(turns), abs=1e-9)
    assert turns >= 1 - 1e-9
    assert story.shots[0].over(seconds / 2).rate
    assert telling.drawing.wide < telling.drawing.high


@pytest.mark.parametrize("part", [0.0, 0.03, 0.5, 0.995, 1.0])
def test_a_loop_of_a_motion_that_ends_stops_at_its_event(out_root, part: float) -> None:
    """It shows all of the motion, and comes out of the dark and goes into it."""
    telling = tell()
    motion = telling.film.motion
    motion.period = None
    film = Film(motion, telling.film.parts, telling.film.shot, telling.film.folder, 16 / 9)
    at = motion.time[0] + part * (motion.time[-1] - motion.time[0])
    story = planned(film, None, [_bell(at)], PRESETS["draft"], 12.0)
    [shot] = story.shots
    assert shot.model(0.0) == pytest.approx(motion.time[0], abs=1e-9)
    assert shot.model(12.0) == pytest.approx(motion.time[-1], abs=1e-9)
    stopped = [k / 30 for k in range(360) if shot.over(k / 30).rate == "time stands still"]
    assert stopped[-1] - stopped[0] > 3
    assert shot.model(stopped[len(stopped) // 2]) == pytest.approx(at, abs=1e-9)
    assert shot.over(0.0).dark == shot.over(12.0).dark == 1.0
    assert shot.over(6.0).dark == 0.0


def test_the_camera_stops_where_all_arrows_are_in_the_picture(out_root, monkeypatch) -> None:
    """From the first distance of those that are tried; a quarter of it is too near for this machine."""
    distances = []
    for tried in ((1.2,), (0.3, 1.2), (0.3,)):
        monkeypatch.setattr(reason, "NEARER", tried)
        telling = tell(Wishes(shots=("reason",)))
        shot, film = telling.story.shots[0], telling.forces
        assert film is not None
        picture = shot.picture(reason.GOES + reason.SLOWS + reason.GROWS + 1.0)
        assert picture.grown == 1.0
        ends = np.array([end for arrow in film.state(picture.at, picture.camera).arrows for end in arrow])
        places = project(picture.camera, ends, film.aspect, 1.0) / [film.aspect, 1.0]
        assert bool(np.abs(places - 0.5).max() < 0.5 - reason.EDGE) == (tried[-1] == 1.2)
        distances.append(picture.camera.position)
    assert distances[0] == distances[1] != distances[2]


def slope(at, s: float, h: float = 1e-5) -> float:
    return (at(s + h) - at(s - h)) / (2 * h)


def test_the_rate_is_the_slope_of_the_time() -> None:
    ramp = Ramp(2.0, ((1.0, 0.5, 0.5), (2.0, 0.5, 0.0), (1.5, 0.0, 0.0), (1.0, 0.0, 3.0)))
    assert ramp.seconds == 5.5
    assert ramp.time_at(0.0) == 2.0
    assert ramp.time_at(1.0) == pytest.approx(2.5)
    assert ramp.time_at(3.0) == ramp.time_at(4.4) == pytest.approx(3.0)  # slowing goes half as far
    assert ramp.time_at(9.0) == ramp.time_at(5.5) == pytest.approx(4.5)
    for s in np.linspace(0.05, 5.45, 61):
        if min(abs(s - edge) for edge in (1.0, 3.0, 4.5)) > 1e-3:
            assert slope(ramp.time_at, float(s)) == pytest.approx(ramp.rate(float(s)), abs=1e-6)


def test_a_rate_is_written_where_it_holds_for_a_second_and_in_steps_where_it_never_does() -> None:
    ramp = Ramp(2.0, ((1.5, 0.5, 0.5), (2.0, 0.5, 0.0), (1.5, 0.0, 0.0), (0.9, 3.0, 3.0)))
    assert [ramp.shown_rate(s) for s in (0.2, 1.4, 1.6, 3.4, 3.6, 4.9, 5.2)] == [0.5, 0.5, None, None, 0.0, 0.0, None]
    rates = np.geomspace(1e-4, 1e4, 400)
    written = [stepped(float(rate)) for rate in rates]
    assert {f"{rate:e}"[0] for rate in written} == {"1", "2", "5"}
    assert np.abs(np.log(np.divide(written, rates))).max() < np.log(2.5) / 2 + 1e-9


@pytest.mark.parametrize("event", [0.0, 0.1, 0.7, 30.0])
def test_it_stops_at_the_event_and_begins_within_the_motion(event: float) -> None:
    ramp = into(event, 0.0, 0.25, 1.0, 2.0)
    assert ramp.time_at(ramp.seconds) == pytest.approx(event, abs=1e-12)
    assert ramp.rate(ramp.seconds) == 0.0
    assert ramp.time_at(0.0) >= -1e-12
    assert ramp.rate(0.0) <= 0.25 + 1e-12
    assert ramp.rate(0.0) == pytest.approx(0.25 if event >= 0.5 else event / 2)


def test_dull_parts_go_fast() -> None:
    time = np.linspace(0, 10, 101)
    happens = np.where((time > 4) & (time < 5), 1.0, 0.0)
    warp = warped(time.tolist(), happens, 0.0, 10.0, 6.0)
    assert (warp.time_at(0.0), warp.time_at(6.0), warp.seconds) == (0.0, 10.0, pytest.approx(6.0))
    times = [warp.time_at(float(s)) for s in np.linspace(0, 6, 200)]
    assert np.all(np.diff(times) > 0)
    middle = float(np.interp(4.5, warp.motion, warp.film))
    assert warp.rate(middle) < 0.6 * warp.rate(0.5)
    assert warp.rate(middle) == pytest.approx(slope(warp.time_at, middle, 0.02 * 6), rel=1e-6)
