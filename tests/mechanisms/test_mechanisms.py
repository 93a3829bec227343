"""Every folder of mechanisms/ runs through its stages; their motions and studies."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import mbsd
from mechanisms.four_bar.mechanism import Params, build
from mechanisms.stages.loading import loading
from mechanisms.stages.parts.meshes import VOLUME_TOLERANCE
from mechanisms.stages.parts_files import read_mesh
from mechanisms.stages.solve.masses import bare_solution
from render import glb
from render.film.composing import KEPT, WHOLE, View, cut_share, shown_area
from render.film.film import Film
from render.film.framing import CameraPose, in_studio
from render.film.inputs import read_film
from render.frames.story.telling import Telling, telling_of
from render.insights import insights
from render.insights.stops import stops
from render.presets import PRESETS, WIDE
from render.sound.setting import RATE
from render.sound.sound import sound_of_story
from shared import contract
from shared.contract.shot import Names, read_shot, refuse_unknown
from shared.stage.paths import Out, planar_names
from tests.mechanisms.author_project import folders_and_variants
from tests.render.filling import boxes, filled, refuse_overlaps
from tests.render.glb_file import GlbFile
from tests.render.insights.recomputed import ELSEWHERE, RECOMPUTED
from tests.render.sound.heard import short_term
from tests.running.warm import Warm

# Every folder of mechanisms/, without being told: it solves, closes, has solids, a shot and a GLB, never touches.


STAGES = ("parts", "solve", "clearance", "shot")
SLOW = {
    *("bicycle_leg", "four_bar_bicycle", "four_bar_motor", "jansen_leg", "pantograph", "peaucellier", "scissor_lift"),
    *("inverse_slider_crank", "quick_return", "rotating_constraint", "slider_crank", "swing_table", "toggle_clamp"),
    *("bending_stiffness", "cam_follower_angular", "chain", "double_pendulum", "mass_spring_damper", "moving_pendulum"),
    *("cycloidal_drive", "ratchet", "walschaerts", "chain_tensioner"),
    *("hip_thrust", "planetary_gear", "rack_steering", "reflective_wall", "vibration_slider_crank", "windshield_wiper"),
    *(
        "flat_four",
        "gravitation",
        "inline_four",
        "quarter_car",
        "radial_five",
        "single_cylinder",
        "trammel",
        "v6",
        "v8",
    ),
}
"""Folders whose like is among the others, which are run each time as new ones are; these are slow tests."""


@pytest.fixture(
    scope="module",
    params=[pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in planar_names()],
)
def products(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, warm: Warm) -> tuple[str, Path]:
    """All stages before the pictures, run as a user runs them."""
    root = tmp_path_factory.mktemp(request.param)
    for stage in STAGES:
        run = warm.run("mechanisms", stage, request.param, MBSD_OUT=str(root))
        assert run.returncode == 0, f"{stage}: {run.stdout}{run.stderr}"
    return request.param, root


@pytest.fixture
def out(products: tuple[str, Path], monkeypatch: pytest.MonkeyPatch) -> Out:
    monkeypatch.setenv("MBSD_OUT", str(products[1]))
    return Out(products[0])


def test_it_closes_and_its_drivers_fix_every_freedom(out: Out) -> None:
    """A simulated one is free, and keeps its energy but for what impacts take; a driven one comes to no dead point."""
    motion = contract.read_motion(out.motion)
    assert motion.diagnostics.position_residual < 1e-10
    assert motion.diagnostics.velocity_residual < 1e-8
    assert motion.diagnostics.acceleration_residual < 1e-6
    if motion.analysis == "simulation":
        assert motion.diagnostics.dof > len(motion.drivers)
        audit = np.array(motion.energy.audit) - _taken_by_impacts(motion)
        assert np.ptp(audit) < 1e-5 * (np.ptp(motion.energy.kinetic) + np.ptp(motion.energy.potential))
        return
    assert motion.diagnostics.dof == len(motion.drivers)
    assert motion.diagnostics.power_residual < 1e-8
    assert min(motion.diagnostics.singularity_margin) > 1e-4


def _taken_by_impacts(motion: contract.Motion) -> np.ndarray:
    """(T,) energy (J) that the impacts up to each row have changed; of two rows at an impact the second is after it."""
    time, energy = np.array(motion.time), np.zeros(len(motion.time))
    for event in motion.events:
        before = int(np.searchsorted(time, event.time))
        energy[before + 1 if before < len(time) and time[before] == event.time else before :] += event.energy
        driven = bool(motion.drivers)  # a driver may give energy in an impact
        assert driven or event.what != "impact" or event.energy <= 1e-12 * max(motion.energy.kinetic)
    return energy


def test_pins_of_two_bodies_stay_together(out: Out) -> None:
    """From the file alone: both sides of every revolute joint, placed by the poses of their bodies, coincide."""
    motion = contract.read_motion(out.motion)
    m = loading.load(out.name, "mechanism").build(loading.params(out.name))
    for joint in m.joints.values():
        if joint.kind.name != "revolute":
            continue
        places = []
        for marker in (joint.i, joint.j):
            body = motion.bodies.get(marker.body.name)
            if body is None:
                places.append(np.broadcast_to([marker.x, marker.y], (len(motion.time), 2)))
                continue
            c, s = np.cos(body.theta), np.sin(body.theta)
            x = np.array(body.x) + c * marker.x - s * marker.y
            places.append(np.stack([x, np.array(body.y) + s * marker.x + c * marker.y], axis=1))
        np.testing.assert_allclose(places[0], places[1], atol=1e-12)


def test_solids_and_bodies_have_the_same_names_and_masses(out: Out) -> None:
    """But for masses that mechanism.py gives, which may be 0, and bodies that are left out."""
    m = loading.load(out.name, "mechanism").build(loading.params(out.name))
    motion, parts = contract.read_motion(out.motion), contract.read_parts(out.parts)
    assert (set(parts.bodies) | set(parts.without_solids)) - {"ground"} == set(motion.bodies)
    for name, body in motion.bodies.items():
        assert body.mass > 0 or (body.mass_from == "mechanism" and m.bodies[name].mass == 0)
        if name in parts.without_solids:
            assert body.mass_from in ("mechanism", "estimate")
        if name in parts.without_solids or body.mass_from == "mechanism":
            continue
        assert body.mass_from == "parts"
        assert (body.mass, body.com, body.inertia) == (
            parts.bodies[name].mass.mass,
            parts.bodies[name].mass.com,
            parts.bodies[name].mass.inertia,
        )


def test_solids_are_closed_and_of_the_size_that_is_told(out: Out) -> None:
    parts = contract.read_parts(out.parts)
    for body in parts.bodies.values():
        for piece in body.pieces.values():
            mesh = read_mesh((out.parts_folder / piece.stl).read_bytes())
            assert mesh.is_watertight
            assert mesh.volume * 1e-9 == pytest.approx(piece.mass.volume, rel=VOLUME_TOLERANCE)
            assert mesh.bounds[:, 2] / 1000 == pytest.approx(np.array(piece.z_range), abs=1e-6)
            assert len(mesh.faces) == piece.triangles


@pytest.fixture(scope="module")
def telling(products: tuple[str, Path]) -> Iterator[Telling]:
    """Return the story that the tests of one machine share."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(products[1]))
        yield telling_of(Out(products[0]), PRESETS["draft"])


SLIVER, SMALL = 0.15, 0.15
"""Part of a plate or stand that a picture cuts, where it cuts it; of a picture, that the room of the machine takes."""
SPARSE = ("four_bar_bicycle",)
"""A machine whose closer stands cut its many pieces by slivers; in 9:16 one is cut by 13 %."""
MOVES, STANDS, JUMP = 0.8, 0.1, 12.0
"""Parts of a story in which the picture moves at least and time stands still at most; LU in a second."""


def test_its_story_is_made_without_a_line_in_its_folder(telling: Telling) -> None:
    """20 to 40 s, few more pictures than a loop film of 3 s or more, time monotone, no camera among the parts."""
    story, clock = telling.story, telling.film.clock
    assert 20 <= story.seconds <= 40
    assert len(story.pictures) <= 2.5 * max(clock.frames, 3.0 * telling.film.shot.fps)
    assert story.placed[0].shot.name == "title"
    assert all(caption.text and 0 <= caption.start < caption.end <= story.seconds for caption in story.captions)
    top = float(telling.film.space.all[:, 2].max())
    assert min(picture.camera.position[2] for picture in story.pictures) > top
    for placed in story.placed:
        times = [placed.shot.model(k / story.fps) for k in range(placed.end - placed.first)]
        back = np.flatnonzero(np.diff(times) < -1e-12)
        assert clock.repeats or placed.shot.name == "motion" or not len(back)
        frame = max(1e-3 * (clock.end - clock.start), 1.01 * clock.rate / story.fps)
        assert all(times[k + 1] == pytest.approx(clock.start, abs=frame) for k in back)


def test_its_story_moves_and_is_heard_from_the_first_second(telling: Telling) -> None:
    story, clock = telling.story, telling.film.clock
    pictures = [story.picture(frame) for frame in range(0, story.total, story.step)]
    assert np.mean([a != b for a, b in itertools.pairwise(pictures)]) >= MOVES
    assert np.mean([story.over(frame).rate == "time stands still" for frame in range(story.total)]) <= STANDS
    heard = story.time_map(clock.start, clock.end, clock.repeats)
    assert (heard.moments_at(np.linspace(0.02, 0.98, 20))[1] > 0.0).all()


def test_its_story_is_never_suddenly_loud(telling: Telling) -> None:
    """By loudness of 3 s each, as EBU R 128 has it; nor is its first second silent."""
    clock = telling.film.clock
    wave = sound_of_story(telling.film, telling.story.time_map(clock.start, clock.end, clock.repeats))
    assert np.abs(wave[:, :RATE]).max() > 1e-3
    level = short_term(wave, 0.5)
    assert (level[2:] - level[:-2]).max() <= JUMP


def _seen(film: Film, camera: CameraPose) -> tuple[View, np.ndarray]:
    """Return a camera as a view, and its place in the studio."""
    view = View(camera.azimuth, camera.elevation, camera.lens, 0.0, aspect=film.aspect)
    return view, in_studio(np.array(camera.position), camera.up)


def _cuts(film: Film, camera: CameraPose) -> list[float]:
    """Return the parts of plate and stand that are cut."""
    view, at = _seen(film, camera)
    shares = [cut_share(view, at, in_studio(thing, camera.up)) for thing in film.subject.things]
    return [share for share in shares if share > WHOLE]


def test_its_machine_is_large_in_the_median_shot_and_nothing_is_cut_by_a_sliver(telling: Telling) -> None:
    """The machine is the room of all that moves; plate and stand are looked at where a camera begins and ends."""
    story, film = telling.story, telling.film
    areas = []
    for placed in story.placed:
        middle = story.picture((placed.first + placed.end) // 2)
        view, at = _seen(film, middle.camera)
        areas.append(shown_area(view, at, in_studio(film.subject.few + film.way(middle.at), middle.camera.up)))
        if placed.shot.name not in ("assembly", "macro", "section"):
            for frame in (placed.first, placed.end - 1):
                cuts = _cuts(film, story.picture(frame).camera)
                assert min(cuts, default=1.0) >= SLIVER, (placed.shot.name, frame)
    assert np.median(areas) >= (SMALL if film.motion.mechanism not in SPARSE else 0.14)


SMALL_TALK = {"stroke", "bend", "reach", "even_return", "period", "energy_kept"}
"""Kinds that are no insight by themselves."""
LONGEST = 150
"""Letters of a sentence; more than a caption holds."""


def test_it_has_three_insights_whose_numbers_are_those_of_the_motion(out: Out) -> None:
    """Each number once more by another formula, from data.json; what a caption may say is among these."""
    motion = contract.read_motion(out.motion)
    findings = insights(motion)
    assert len({each.kind for each in findings} - SMALL_TALK) >= 3, [each.sentence() for each in findings]
    for each in (*findings, *stops(motion)):
        assert each.kind in RECOMPUTED or each.kind in ELSEWHERE
        for told, again in RECOMPUTED[each.kind](motion, each) if each.kind in RECOMPUTED else ():
            assert told == pytest.approx(again, rel=0.02, abs=0.01), (each.kind, each.sentence())
    for each in findings:
        for said in (each.sentence(language) for language in ("en", "de")):
            assert len(said) <= LONGEST, said
            assert re.match(r"[A-Z0-9ÄÖÜ].*\.$", said), said
            assert not re.search(r"[{}_]|\bnan\b|no number", said), said
        assert each.start <= each.end
        assert np.isfinite(each.number)


def test_the_glb_moves_as_data_json_has_it(out: Out) -> None:
    """Corners of the box round all pieces of a body, at samples all over the motion, to 0.01 mm."""
    glb.run(out.name)
    motion, parts = contract.read_motion(out.motion), contract.read_parts(out.parts)
    glb_file = GlbFile(out.glb.read_bytes())
    boxes = {body: glb_file.box_of(body) for body in parts.bodies}
    assert set(boxes) == {name for name in glb_file.nodes if name in {"ground", *motion.bodies}}
    start, time, turned = motion.time[0], np.array(motion.time), _with_y_up(parts.mount.up)
    for t in glb_file.clock[:: max(1, len(glb_file.clock) // 12)]:
        k = int(np.abs(time - start - t).argmin())
        matrices = glb_file.matrices(float(t))
        for body, corners in boxes.items():
            pose = motion.bodies.get(body)
            x, y, angle = (pose.x[k], pose.y[k], pose.theta[k]) if pose else (0.0, 0.0, 0.0)
            place = (corners[:, 0] + 1j * corners[:, 1]) * np.exp(1j * angle) + complex(x, y)
            upright = np.column_stack([place.real, place.imag, corners[:, 2]]) @ turned.T
            np.testing.assert_allclose((corners @ matrices[body][:3, :3].T) + matrices[body][:3, 3], upright, atol=1e-5)


def _with_y_up(up: tuple[float, float, float]) -> np.ndarray:
    """(3, 3) that turns what points up into glTF's y: z of what lies, a direction of the plane of what stands."""
    x, y, z = up
    return np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]] if z else [[y, -x, 0], [x, y, 0], [0, 0, 1]], dtype=float)


def test_the_shot_names_what_there_is(out: Out) -> None:
    refuse_unknown(
        read_shot(out.shot), Names.from_motion(contract.read_motion(out.motion), contract.read_parts(out.parts))
    )


def test_a_second_run_has_nothing_to_do(products: tuple[str, Path], warm: Warm) -> None:
    name, root = products
    before = {path: path.read_bytes() for path in sorted(root.rglob("*.json"))}
    for stage in STAGES:
        assert "nothing to do" in warm.run("mechanisms", stage, name, MBSD_OUT=str(root)).stdout
    assert {path: path.read_bytes() for path in sorted(root.rglob("*.json"))} == before


def test_solving_anew_gives_the_same_bytes(products: tuple[str, Path], out: Out, warm: Warm) -> None:
    before = out.motion.read_bytes()
    out.motion.unlink()
    assert warm.run("mechanisms", "solve", products[0], MBSD_OUT=str(products[1])).returncode == 0
    assert out.motion.read_bytes() == before


def test_it_fills_wide_and_tall_pictures_and_its_words_have_room(out: Out) -> None:
    """The mechanism fills four fifths of the width or height, and nothing written overlaps.

    Where plate and stand are whole for it, it may fill three quarters of that; none of them is cut by a sliver.
    It is measured on coarse solids, springs and belts over the film; with titles and all arrows at once, too, nothing
    that is written overlaps or leaves the picture.
    """
    for aspect in (WIDE, "9:16"):
        shape = PRESETS["draft"].framed(aspect).aspect
        film = read_film(out, "", shape)
        cuts = _cuts(film, film.camera(0))
        assert min(cuts, default=1.0) >= (SLIVER if out.name not in SPARSE else 0.12), aspect
        assert (
            filled(film) >= (1.0 if (cuts or not film.subject.things) and out.name not in SPARSE else KEPT) * 0.8 - 5e-3
        ), aspect
        written = boxes(read_film(out, "velocities,accelerations,forces,reactions,title", shape))
        assert len(written) >= 2
        refuse_overlaps(written)


# Every mechanism of mechanisms/ and each variant: its motion from mechanism.py alone, before it has parts.
#
# All stages of every folder are run by test_mechanisms.py, for the large ones among the slow tests.


@pytest.mark.parametrize("name", folders_and_variants())
def test_its_motion_closes_at_all_times_and_has_no_gaps(name: str) -> None:
    solution = bare_solution(name)
    assert solution.stats.position_residual < 1e-10
    assert solution.stats.velocity_residual < 1e-8
    assert solution.stats.acceleration_residual < 1e-6
    for body in solution.mechanism.bodies:
        motion = solution.body(body)
        assert np.isfinite(np.column_stack([motion.x, motion.y, motion.theta, motion.omega, motion.alpha])).all()
    moved = [np.ptp(solution.body(body).x) + np.ptp(solution.body(body).theta) for body in solution.mechanism.bodies]
    assert max(moved) > 1e-3, "something moves"


# A study over the gallery's Params, which are a frozen dataclass, is kept.


def test_params_of_the_gallery_are_kept(tmp_path: Path) -> None:
    def build_crank(crank: float) -> mbsd.Mechanism:
        return build(Params(crank=crank))

    points = {"crank": [0.03, 0.04]}
    for _ in range(2):
        table = mbsd.study(
            build_crank, points, lambda m: {"n": len(m.bodies)}, folder=tmp_path, processes=1, progress=False
        )
        assert list(table["n"]) == [4, 4]
    assert len(list(tmp_path.rglob("*.jsonl"))) == 1
