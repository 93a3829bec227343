"""Mechanisms in space through the stages: motion against closed forms, parts that are whole and keep apart."""

from __future__ import annotations

import importlib
import math
import sys
from functools import cache
from typing import Any

import numpy as np
import pytest
from msgspec.structs import replace

from mbsd.spatial import Mechanism
from mbsd.spatial.model.rotation import rotation_matrix
from mechanisms.__main__ import main
from mechanisms.bennett import mechanism as bennett
from mechanisms.bevel_differential import mechanism as differential
from mechanisms.bicycle import mechanism as bicycle
from mechanisms.bricard import mechanism as bricard
from mechanisms.delta_robot import mechanism as delta
from mechanisms.governor import mechanism as governor
from mechanisms.gyroscope import mechanism as gyroscope
from mechanisms.heavy_top import mechanism as top
from mechanisms.rolling_coin import mechanism as coin
from mechanisms.rssr import mechanism as rssr
from mechanisms.sarrus import mechanism as sarrus
from mechanisms.simple_car import mechanism as car
from mechanisms.spatial_slider_crank import mechanism as slider_crank
from mechanisms.stages.automatic.space.machine import link_poses, solids_in_space
from mechanisms.stages.automatic.space.moves import Moves
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.stage import check
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from mechanisms.stages.solve.space.motion_file import to_motion3
from mechanisms.stages.solve.stage import solve
from mechanisms.stewart_platform import mechanism as stewart
from mechanisms.swash_plate_pump import mechanism as pump
from mechanisms.wobble_engine import mechanism as wobble
from shared.contract.clearance import Clearance
from shared.contract.parts import Link
from shared.shapes.facets import volume_of
from shared.stage.errors import UserError
from shared.stage.paths import mechanism_names, planar_names
from tests.mechanisms.clearance.clearance_pieces import parts_of

NAMES = sorted(set(mechanism_names()) - set(planar_names()))
MANY_PIECES = {"bicycle", "bricard", "delta_robot", "governor", "sarrus", "schatz_mixer", "simple_car"}
MANY_PIECES |= {"stewart_platform", "wobble_engine"}
"""Machines whose solids take seconds; the others have every kind of part but a cylinder with its rod."""
PROVEN = ("cardan_shaft",)
"""Machines of which the proof is quick."""
SEARCHED = ("bevel_differential", "heavy_top", "rssr", "sarrus", "spatial_slider_crank")
"""Machines of which `make test-slow` has the proof."""


@cache
def solution(name: str) -> Any:
    """Return the motion of a mechanism of the gallery as its stage solves it."""
    return solve(name, None)[0]


def test_the_gallery_has_mechanisms_in_space() -> None:
    assert {"cardan_shaft", "heavy_top", "rssr", "sarrus", "spatial_slider_crank"} <= set(NAMES)
    assert len(NAMES) == 18
    assert "four_bar" in planar_names()


@pytest.mark.parametrize("name", NAMES)
def test_its_file_is_short_and_its_motion_closes(name: str) -> None:
    module = importlib.import_module(f"mechanisms.{name}.mechanism")
    with open(str(module.__file__)) as file:
        assert len(file.readlines()) <= 60
    stats = solution(name).stats
    assert stats.position_residual < 1e-10
    assert stats.velocity_residual < 1e-8
    assert stats.acceleration_residual < (1e-4 if name == "governor" else 1e-6)  # one row of its tree is redundant


# -- motions against closed forms ------------------------------------------------------------------------------------


def test_the_cardan_shaft_turns_its_output_as_its_input() -> None:
    """Both bends alike and the middle yokes in one plane: ratio 1; the middle runs between cos b and 1 / cos b."""
    from mechanisms.cardan_shaft import mechanism as cardan

    sol, p = solution("cardan_shaft"), cardan.Params()
    np.testing.assert_allclose(sol.joint("bearing_out").turn_rate, p.speed, rtol=1e-12)
    axis = np.array([math.cos(math.radians(p.bend)), math.sin(math.radians(p.bend)), 0.0])
    middle = sol.body("middle").w @ axis
    assert middle.max() == pytest.approx(p.speed / math.cos(math.radians(p.bend)), rel=1e-9)
    assert middle.min() == pytest.approx(p.speed * math.cos(math.radians(p.bend)), rel=1e-9)


def test_the_heavy_top_keeps_its_energy_and_both_momenta() -> None:
    """Energy, the angular momentum about the vertical, and the spin about its axis (Goldstein, section 5.7)."""
    sol, p = solution("heavy_top"), top.Params()
    view, total = sol.body("top"), sol.energy.total
    assert np.ptp(total) < 1e-8 * abs(total).max()
    body = sol.mechanism.bodies["top"]
    axial, cross = body.inertia[0][0], body.inertia[1][1]
    axis = view.rotation[:, :, 0]
    spin = (view.w * axis).sum(axis=1)
    np.testing.assert_allclose(spin, p.spin, rtol=1e-9)
    arm = p.stem * axis
    momentum = p.mass * np.cross(arm, np.cross(view.w, arm)) + cross * view.w + ((axial - cross) * spin)[:, None] * axis
    np.testing.assert_allclose(momentum[:, 2], momentum[0, 2], rtol=1e-8)
    # Mean precession of a fast top: m g l / (I3 w3)
    turned = np.unwrap(np.arctan2(axis[:, 1], axis[:, 0]))
    rate = p.mass * 9.80665 * p.stem / (axial * p.spin)
    assert (turned[-1] - turned[0]) / (sol.t[-1] - sol.t[0]) == pytest.approx(rate, rel=0.03)


def test_the_slider_crank_meets_the_numbers_of_haug() -> None:
    """Haug 1989, section 10.2: slider at start .2 m and at a quarter turn .20784609690826528 m, and the rod is .3 m."""
    p = slider_crank.Params()
    sol = slider_crank.build(p).sweep(steps=360)
    turn = sol.joint("shaft").turn
    y, z = p.beside
    across = np.hypot(y - p.crank * np.sin(turn), z + p.crank * np.cos(turn))
    np.testing.assert_allclose(sol.body("slider").place[:, 0], np.sqrt(p.rod**2 - across**2), atol=1e-12)
    assert sol.body("slider").place[0, 0] == pytest.approx(0.2, abs=1e-12)
    assert 0.2 < sol.body("slider").place[:, 0].max() < 0.2902


def test_the_rssr_meets_haugs_range_of_its_rocker() -> None:
    """Haug 1989, section 10.3: the rocker swings between 45.11356 and 131.01408 degrees from the -x axis."""
    p = rssr.Params()
    sol = rssr.build(p).sweep(steps=1440)
    end = sol.point("P").place - np.array([p.beside[0], p.beside[1], 0.0])
    angle = np.degrees(np.arctan2(end[:, 2], -end[:, 0]))
    assert [angle.min(), angle.max()] == pytest.approx([45.11356, 131.01408], abs=2e-4)
    pin = sol.place(sol.mechanism.joints["coupler"].i).place
    np.testing.assert_allclose(np.linalg.norm(pin - sol.point("P").place, axis=1), p.coupler, atol=1e-12)


def test_the_sarrus_linkage_moves_its_platform_straight_up_and_holds_one_row_twice() -> None:
    sol, p = solution("sarrus"), sarrus.Params()
    view = sol.body("platform")
    assert np.abs(view.place[:, :2]).max() < 1e-12
    assert np.abs(view.rotation - np.eye(3)).max() < 1e-12
    angle = math.radians(p.middle) - sol.joint("foot_x").turn
    np.testing.assert_allclose(view.place[:, 2], 2 * p.link * np.sin(angle), atol=1e-12)
    assert sol.mobility.dof == 1
    assert sol.mobility.redundant_rows == 1


def test_the_gyroscope_precesses_at_the_torque_over_the_momentum_of_its_disc() -> None:
    sol, p = solution("gyroscope"), gyroscope.Params()
    np.testing.assert_allclose(sol.joint("post").turn_rate, gyroscope.precession(p), rtol=1e-6)
    assert np.abs(sol.joint("hinge").turn).max() < 1e-6


def test_the_governor_at_a_steady_speed_stands_where_its_weights_balance() -> None:
    """Virtual work of weights and of centrifugal forces; without sleeve and links the height is g / w^2."""
    p = governor.Params(swing=0.0, damper=12.0)
    arm = governor.build(p).simulate(duration=8.0, steps=20).body("arm_left").place[-1]
    radius = float(np.hypot(arm[0], arm[1]))
    sine = (radius - p.beside) / p.arm
    cosine = math.sqrt(1.0 - sine**2)
    assert arm[2] == pytest.approx(-p.arm * cosine, abs=1e-4)
    pull = p.ball * radius * p.arm * cosine + p.rod * (p.beside + p.link * sine / 2) * p.link * cosine / 2
    weight = (p.ball * p.arm + 1.5 * p.rod * p.link + p.sleeve * p.link) * sine * 9.80665
    assert p.mean**2 * pull == pytest.approx(weight, rel=1e-3)


def test_the_delta_robot_takes_its_platform_round_a_circle_without_turning_it() -> None:
    """Angles of the arms at (0.06, -0.04, -0.42) by inverse kinematics in other coordinates, in degrees."""
    sol, p = solution("delta_robot"), delta.Params()
    view = sol.body("platform")
    circle = p.circle * np.stack([np.cos(p.speed * sol.t), np.sin(p.speed * sol.t)], axis=1)
    np.testing.assert_allclose(view.place[:, :2], circle, atol=1e-8)
    assert np.abs(view.rotation - np.eye(3)).max() < 1e-8
    angles = [math.degrees(delta.angle(p, (0.06, -0.04, -0.42), k * 2 * math.pi / 3)) for k in range(3)]
    assert angles == pytest.approx([19.98974845310761, 45.93069592471842, 32.16201139964748], abs=1e-10)


def test_legs_of_the_stewart_platform_have_the_lengths_that_its_pose_asks_for() -> None:
    sol, p = solution("stewart_platform"), stewart.Params()
    for k in range(6):
        foot, head = (sol.place(sol.mechanism.joints[f"{word}_{k + 1}"].i).place for word in ("cross", "ball"))
        length = np.linalg.norm(head - foot, axis=1)
        stroke = p.stroke * np.sin(p.speed * sol.t - 2 * math.pi * (k // 2) / 3)
        np.testing.assert_allclose(np.ptp(length - stroke), 0.0, atol=1e-12)
    assert np.linalg.norm(sol.body("platform").rotation[:, :2, 2], axis=1).min() > 0.1  # it tilts all the way round
    assert (sol.mobility.dof, sol.mobility.redundant_rows) == (6, 0)


def test_the_bennett_linkage_keeps_the_product_of_the_tangents_of_its_half_turns() -> None:
    sol, p = solution("bennett"), bennett.Params()
    alpha, beta = math.radians(p.twist), math.radians(p.other)
    ratio = math.sin((beta + alpha) / 2) / math.sin((beta - alpha) / 2)
    first = math.radians(p.middle)
    second = 2 * math.atan(ratio / math.tan(first / 2))
    turns = first + sol.joint("hinge_1").turn, second + sol.joint("hinge_2").turn
    np.testing.assert_allclose(np.tan(turns[0] / 2) * np.tan(turns[1] / 2), ratio, rtol=1e-10)
    assert (sol.mobility.dof, sol.mobility.redundant_rows) == (1, 3)


def test_the_bricard_linkage_keeps_the_relation_of_its_turns() -> None:
    sol, p = solution("bricard"), bricard.Params()
    first = math.radians(p.middle)
    second = math.acos(-math.cos(first) / (1 + math.cos(first)))
    a, b = np.cos(first + sol.joint("hinge_1").turn), np.cos(second + sol.joint("hinge_2").turn)
    assert np.abs(a + b + a * b).max() < 1e-10
    assert (sol.mobility.dof, sol.mobility.redundant_rows) == (1, 1)


def test_pistons_of_the_swash_plate_pump_move_as_a_cosine() -> None:
    sol, p = solution("swash_plate_pump"), pump.Params()
    slide = sol.joint("bore_1").slide
    wanted = p.circle * math.tan(math.radians(p.tilt)) * (np.cos(p.speed * sol.t) - 1.0)
    np.testing.assert_allclose(slide, wanted, atol=1e-12)


def test_shafts_of_the_bevel_differential_turn_at_the_mean_of_its_cage() -> None:
    sol, p = solution("bevel_differential"), differential.Params()
    left, right = (sol.body(name).w[:, 0] for name in ("left", "right"))
    cage = sol.body("cage").w[:, 0]
    np.testing.assert_allclose(left + right, 2 * cage, atol=1e-10)
    assert np.ptp(left - right) > 1.0
    pin = sol.joint("pin").turn_rate
    np.testing.assert_allclose(np.abs(pin), np.abs(left - cage) * p.side / p.planet, atol=1e-10)


def test_the_coin_rolls_round_its_circle_at_its_closed_rate() -> None:
    """A thin coin of radius 0.3 at 20 degrees on a circle of 1.2: turn 1.3984872, spin -6.0722596 rad/s at g 9.81."""
    sol, p = solution("rolling_coin"), coin.Params()
    place, turn = sol.point("P").place, coin.rates(p)[0]
    np.testing.assert_allclose(place[:, 0], p.circle * np.cos(turn * sol.t), atol=1e-6)
    np.testing.assert_allclose(place[:, 1], p.circle * np.sin(turn * sol.t), atol=1e-6)
    thin = coin.rates(coin.Params(ring=0.3, rim=0.0, circle=1.2))
    wanted = np.array([1.3984872052205763, -6.072259615250961]) * math.sqrt(9.80665 / 9.81)
    np.testing.assert_allclose(thin, wanted, rtol=1e-9)


def test_the_bicycle_has_the_eigenvalues_of_its_benchmark_and_rights_itself() -> None:
    """Meijaard, Papadopoulos, Ruina, Schwab 2007, table 2, at 5 m/s."""
    values = bicycle.build(bicycle.Params(push=0.0)).linearise("start").eigenvalues
    for wanted in (-14.078389692798, -0.775341882196 + 4.464867713788j, -0.322866429004):
        assert np.abs(values - wanted).min() < 1e-7
    lean = np.degrees(np.arcsin(-solution("bicycle").body("frame").rotation[:, 1, 2]))
    assert 3.0 < lean.max() < 6.0
    assert abs(lean[-1]) < 2.0


def test_the_plate_of_the_wobble_engine_leans_with_its_shaft_and_does_not_turn() -> None:
    """Its normal goes round a cone of the bend; its own turn about the normal stays small."""
    sol, p = solution("wobble_engine"), wobble.Params()
    bend = math.radians(p.bend)
    normal = sol.body("plate").rotation @ np.array([math.cos(bend), 0.0, math.sin(bend)])
    turn = p.speed * sol.t
    cone = [np.full_like(turn, math.cos(bend)), -math.sin(bend) * np.sin(turn), math.sin(bend) * np.cos(turn)]
    np.testing.assert_allclose(normal, np.stack(cone, axis=1), atol=1e-12)
    assert np.abs(sol.body("plate").rotation[:, 1, 2]).max() < 0.3
    slides = [np.ptp(sol.joint(f"cylinder_{k + 1}").slide) for k in range(p.pistons)]
    assert min(slides) > 1.9 * p.circle * math.sin(bend)


def test_the_simple_car_goes_round_the_circle_of_its_steering() -> None:
    """The middle of its rear axle has the radius base / tan(steering), but for the slip of its tyres."""
    sol, p = solution("simple_car"), car.Params()
    late = sol.t > 0.5
    radius = np.linalg.norm(sol.point("P").velocity, axis=1)[late] / sol.body("body").w[late, 2]
    np.testing.assert_allclose(radius, p.base / math.tan(math.radians(p.steer)), rtol=0.02)
    assert sol.body("wheel_rear_left").place[:, 2].min() > 0.98 * p.radius


def test_the_shafts_of_the_schatz_mixer_turn_at_half_to_twice_each_others_rate() -> None:
    """Turns count from the pose in which tan(out) = 2 tan(in)."""
    sol = solution("schatz_mixer")
    turn, out = sol.joint("bearing_in").turn, sol.joint("bearing_out").turn
    np.testing.assert_allclose(np.sin(out) * np.cos(turn), 2 * np.sin(turn) * np.cos(out), atol=1e-9)
    ratio = np.abs(sol.joint("bearing_out").turn_rate / sol.joint("bearing_in").turn_rate)
    assert [ratio.min(), ratio.max()] == pytest.approx([0.5, 2.0], abs=1e-3)
    assert (sol.mobility.dof, sol.mobility.redundant_rows) == (1, 1)


# -- parts -----------------------------------------------------------------------------------------------------------


def meshes(name: str) -> tuple[dict[str, list[Any]], Moves]:
    """Return the meshes of all pieces by body (mm), each checked as the parts stage checks it, and their motion."""
    made = solids_in_space(solution(name))
    out: dict[str, list[Any]] = {}
    for body, solids in made.items():
        for solid in solids:
            shape = only_solid(solid.shape, solid.name)
            mesh = read_mesh(stl_bytes(shape, solid.tolerance))
            check_mesh(mesh, volume_of(shape), solid.through_holes, solid.name)
            out.setdefault(body, []).append(mesh)
    moves = Moves(solution(name).mechanism, solution(name))
    for body, (joint, holder, z) in made.links.items():
        from mechanisms.stages.automatic.space.pieces import Link

        moves.poses[body] = link_poses(moves, Link(joint, [], [], holder, np.array(z)))
    return out, moves


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow) if name in MANY_PIECES else name
        for name in NAMES
        if name not in PROVEN
    ],
)
def test_parts_are_watertight_and_no_two_bodies_share_room(name: str) -> None:
    """At eight poses of the motion, by exact intersections of the meshes."""
    from manifold3d import Manifold, Mesh

    bodies, moves = meshes(name)
    solids = {
        body: [Manifold(Mesh(np.asarray(m.vertices, np.float32), np.asarray(m.faces, np.uint32))) for m in own]
        for body, own in bodies.items()
    }
    rows = np.linspace(0, len(moves.poses["ground"][0]) - 1, 9).round().astype(int)[:-1]
    for row in rows:
        placed: list[tuple[str, Any]] = []
        for body, own in solids.items():
            place, turned = (part[row] for part in moves.poses[body])
            moved = np.column_stack([turned, place])
            placed += [(body, piece.transform(moved)) for piece in own]
        for k, (body, piece) in enumerate(placed):
            for other, another in placed[:k]:
                if other != body:
                    shared = (piece ^ another).volume()
                    assert shared < 1e-3 * min(piece.volume(), another.volume()), (row, body, other, shared)


def proven(solved: Any) -> Clearance:
    """Return the proof of clearance of the automatic parts of a solved mechanism."""
    made, name = solids_in_space(solved), solved.mechanism.name
    pieces = []
    for body, solids in made.items():
        for solid in solids:
            shape = only_solid(solid.shape, solid.name)
            mesh = read_mesh(stl_bytes(shape, solid.tolerance))
            check_mesh(mesh, volume_of(shape), solid.through_holes, solid.name)
            pieces.append(MeshPiece(body, solid.name, np.asarray(mesh.triangles, float)))
    parts = replace(parts_of(pieces), mechanism=name)
    for body, (joint, holder, z) in made.links.items():
        parts.bodies[body] = replace(parts.bodies[body], link=Link(joint=joint, body=holder, z=z))
    bodies = [body for body in solved.mechanism.bodies if body != "ground"]
    motion = to_motion3(solved, dict.fromkeys(bodies, "#0b62a8"), {}, dict.fromkeys(bodies, "mechanism"))
    return check(parts, motion, pieces, "key")


@pytest.mark.parametrize("name", [*PROVEN, *(pytest.param(name, marks=pytest.mark.slow) for name in SEARCHED)])
def test_parts_are_watertight_and_proven_clear_over_the_motion(name: str) -> None:
    """Rings, cups, yokes and pins by their joints, all else by search; nothing is exempt."""
    clearance = proven(solution(name))
    assert min(pair.proven for pair in clearance.pairs) > 0.05e-3
    assert not clearance.may_touch


def test_a_joint_without_a_shape_raises_an_error_that_names_it() -> None:
    m = Mechanism("sheet")
    plate = m.disc("plate", (0, 0, 0), (0, 0, 1), 0.1, mass=1.0, thickness=0.01)
    m.planar("floor", m.ground, plate, at=(0.3, 0, 0), axis=(0, 0, 1))
    with pytest.raises(UserError, match=r"no automatic parts for the planar joint 'floor' in space; write a parts.py"):
        solids_in_space(m.simulate(duration=0.1, steps=5))


def test_a_ball_that_swings_all_round_raises_an_error_that_names_its_joint() -> None:
    m = Mechanism("whirl")
    arm = m.rod("arm", (0, 0, 0), (0.2, 0, 0), mass=1.0, radius=0.01)
    m.spherical("ball", m.ground, arm, at=(0, 0, 0))
    m.start_moving({"arm": (0.0, 0.0, 40.0)})
    with pytest.raises(UserError, match=r"joint 'ball' swings by 1.. degrees to both sides"):
        solids_in_space(m.simulate(duration=0.4, steps=48))


def test_orientation_of_a_link_is_a_rotation_whose_x_axis_is_the_rod() -> None:
    sol = solution("rssr")
    moves = Moves(sol.mechanism, sol)
    from mechanisms.stages.automatic.space.ends import Ends

    (link,) = Ends(moves).links
    place, turned = link_poses(moves, link)
    np.testing.assert_allclose(
        np.einsum("tij,tik->tjk", turned, turned), np.tile(np.eye(3), (len(place), 1, 1)), atol=1e-12
    )
    ends = place + 1000 * rssr.Params().coupler * turned[:, :, 0]
    rows = np.unique(np.linspace(0, len(sol.t) - 1, len(place)).round().astype(int))
    np.testing.assert_allclose(ends, 1000 * sol.point("P").place[rows], atol=1e-8)


def test_masses_of_parts_fill_in_only_where_the_file_gave_none() -> None:
    from mechanisms.stages.solve.space.running import give_masses_of_parts
    from shared.contract import BodyParts, Mass

    tensor = (2e-4, 3e-4, 4e-4, 1e-5, 0.0, 0.0)
    mass = Mass(mass=0.5, com=(0.01, 0.02), inertia=4e-4, volume=1e-4, z=0.03, tensor=tensor)
    parts = {name: BodyParts(pieces={}, mass=mass, z=0.0) for name in ("crank", "slider")}
    m = slider_crank.build(slider_crank.Params())
    sources, _ = give_masses_of_parts(m, parts)
    assert sources == {"crank": "parts", "slider": "mechanism"}
    assert m.bodies["slider"].mass == slider_crank.Params().slider
    crank = m.bodies["crank"]
    assert (crank.mass, crank.com) == (0.5, (0.01, 0.02, 0.03))
    moments, axes = crank.principal
    np.testing.assert_allclose(axes @ np.diag(moments) @ axes.T, crank.inertia, atol=1e-15)
    assert abs(np.linalg.det(rotation_matrix(crank.orientation)) - 1.0) < 1e-12


@pytest.mark.parametrize("command", ["animate", "print", "tolerances", "export", "study", "check"])
def test_commands_for_the_plane_refuse_a_mechanism_in_space(command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["mechanisms", command, "heavy_top"])
    with pytest.raises(UserError, match=r"heavy_top is a mechanism in space, for which there is no .* yet"):
        main()
