"""Published numbers of kinematics and joints."""

from __future__ import annotations

import ast
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import AssemblyError, Mechanism, constant_rate, curve
from mbsd.mechanism import Body, Marker
from mbsd.results.solution import Solution
from mbsd.results.views import FrameView
from tools.models.guided import geneva

# Published four-bars and slider-cranks: numbers of others, each file with its source and tolerance.


FOLDER = Path(__file__).parent / "reference"
RATES = ("x", "y", "vx", "vy", "ax", "ay")


def _case(name: str) -> dict[str, Any]:
    return json.loads((FOLDER / f"{name}.json").read_text())


def _columns(view: FrameView, fields: tuple[str, ...]) -> np.ndarray:
    return np.stack([getattr(view, field) for field in fields], axis=1)


# -- analytic ---------------------------------------------------------------------------------------------------


def test_four_bar_by_freudenstein() -> None:
    expected = _case("analytic_four_bar")["expected"]
    a, b, c, d = (expected["links"][key] for key in ("crank a", "coupler b", "rocker c", "ground d"))
    rows = np.array(expected["rows"])
    m = Mechanism("freudenstein")
    crank, coupler, rocker = m.bar("crank", a), m.bar("coupler", b), m.bar("rocker", c)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(d, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(expected["omega2"]))
    m.start_near(crank=0, coupler=107, rocker=132)
    sol = m.sweep(times=np.radians(rows[:, 0]) / expected["omega2"])
    for name, angle, omega, alpha in (("coupler", 1, 3, 5), ("rocker", 2, 4, 6)):
        view = sol.body(name)
        np.testing.assert_allclose(np.degrees(view.theta), rows[:, angle], rtol=1e-12)
        np.testing.assert_allclose(view.omega, rows[:, omega], rtol=1e-11, atol=1e-11)
        np.testing.assert_allclose(view.alpha, rows[:, alpha], rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize(
    ("key", "r", "rod", "offset", "speed"),
    [("r0.05_l0.15_e0_w100", 0.05, 0.15, 0.0, 100.0), ("r0.06_l0.20_e0.02_w50", 0.06, 0.20, 0.02, 50.0)],
)
def test_slider_crank_in_closed_form(key: str, r: float, rod: float, offset: float, speed: float) -> None:
    rows = np.array(_case("analytic_slider_crank")["expected"][key])
    m = Mechanism("slider_crank")
    crank, conrod, slider = m.bar("crank", r), m.bar("conrod", rod), m.body("slider")
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, conrod.start)
    m.revolute("B", conrod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, offset), slider.origin)
    m.drive_angle("motor", crank, constant_rate(speed))
    m.start_near(crank=0, conrod=0)
    sol = m.sweep(times=np.radians(rows[:, 0]) / speed)
    slide, swing = sol.body("slider"), sol.body("conrod")
    np.testing.assert_allclose(_columns(slide, ("x", "vx", "ax")), rows[:, 1:4], rtol=1e-11, atol=1e-11 * speed**2)
    got = _columns(swing, ("theta", "omega", "alpha"))
    np.testing.assert_allclose(got, rows[:, 4:7], rtol=1e-11, atol=1e-11 * speed**2)


def test_scotch_yoke() -> None:
    expected = _case("analytic_scotch_yoke")["expected"]
    r, w = expected["r"], expected["w"]
    m = Mechanism("scotch_yoke", gravity=None)
    crank, yoke = m.bar("crank", r), m.body("yoke", mass=2.0)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.prismatic("guide", m.ground.at(0, 0), yoke.origin)
    m.pin_in_slot("pin", yoke.at(0, 0, math.pi / 2), crank.end)
    m.drive_angle("motor", crank, constant_rate(w))
    m.start_near(yoke=(r, 0, 0))
    sol = m.sweep(steps=720)
    view, turn = sol.body("yoke"), w * sol.t
    np.testing.assert_allclose(view.x, r * np.cos(turn), atol=1e-14)
    np.testing.assert_allclose(view.vx, -r * w * np.sin(turn), atol=1e-12)
    np.testing.assert_allclose(view.ax, -r * w**2 * np.cos(turn), atol=1e-10)
    torque = sol.driver("motor").torque
    np.testing.assert_allclose(torque, 2.0 * r**2 * w**2 * np.sin(turn) * np.cos(turn), atol=1e-11)
    assert abs(torque).max() == pytest.approx(expected["peak_abs_torque_for_m=2kg"], rel=1e-12)


def test_crank_shaper_quick_return() -> None:
    expected = _case("analytic_crank_shaper")["expected"]["r=0.1,c=0.2,L=0.5"]
    r, c, length = 0.1, 0.2, 0.5
    m = Mechanism("shaper")
    crank, lever = m.bar("crank", r), m.bar("lever", length)
    m.revolute("O", m.ground.at(0, c), crank.start)
    m.revolute("L", m.ground.at(0, 0), lever.start)
    m.pin_in_slot("pin", lever.origin, crank.end)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.trace("tip", lever.end)
    m.start_near(crank=0, lever=60)
    sol = m.sweep(steps=3600)
    tip, omega = sol.point("tip").x, sol.body("lever").omega
    assert tip.max() - tip.min() == pytest.approx(expected["stroke"], rel=1e-6)
    forward = np.mean(omega > 0)
    assert forward / (1 - forward) == pytest.approx(expected["Q"], rel=2e-3)


def test_hoeken_straight_line() -> None:
    expected = _case("analytic_hoeken")["expected"]["points"]
    m = Mechanism("hoeken")
    crank, coupler, rocker = m.bar("crank", 1.0), m.bar("coupler", 5.0), m.bar("rocker", 2.5)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.at(2.5, 0), rocker.end)
    m.revolute("D", m.ground.at(2.0, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.trace("tracer", coupler.end)
    m.start_near(coupler=80, rocker=100)
    degrees = sorted(float(key) for key in expected)
    point = m.sweep(times=np.radians(degrees)).point("tracer")
    wanted = np.array([expected[f"{key:g}"] for key in degrees])
    np.testing.assert_allclose(_columns(point, ("x", "y")), wanted, atol=1e-12)


def test_peaucellier_draws_an_exact_line() -> None:
    expected = _case("analytic_peaucellier")["expected"]
    long, side, r = expected["L"], expected["s"], expected["r"]
    m = Mechanism("peaucellier")
    crank = m.bar("crank", r)
    bars = {
        name: m.bar(name, long if name.startswith("long") else side)
        for name in ("long1", "long2", "c1", "c2", "p1", "p2")
    }
    m.revolute("Q", m.ground.at(r, 0), crank.start)
    for k in "12":
        m.revolute(f"O{k}", m.ground.at(0, 0), bars[f"long{k}"].start)
        m.revolute(f"C{k}", crank.end, bars[f"c{k}"].start)
        m.revolute(f"A{k}", bars[f"long{k}"].end, bars[f"c{k}"].end)
        m.revolute(f"B{k}", bars[f"long{k}"].end, bars[f"p{k}"].start)
    m.revolute("P", bars["p1"].end, bars["p2"].end)
    m.drive_angle("hand", crank, lambda t: 0.9 * math.sin(t))
    m.trace("pen", bars["p1"].end)
    half = math.degrees(math.acos((long**2 + (2 * r) ** 2 - side**2) / (4 * long * r)))
    m.start_near(crank=0, long1=half, long2=-half, c1=67, c2=-67, p1=-67, p2=67)
    sol = m.sweep(duration=2 * math.pi, steps=200)
    pen = sol.point("pen")
    np.testing.assert_allclose(pen.x, expected["x_line"], atol=1e-11)
    assert np.ptp(pen.y) > 3.0


def test_chebyshev_crossed_rockers_draw_nearly_a_line() -> None:
    expected = _case("analytic_chebyshev")["expected"]
    m = Mechanism("chebyshev")
    left, right, coupler = m.bar("left", 5.0), m.bar("right", 5.0), m.bar("coupler", 2.0)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", m.ground.at(4, 0), right.start)
    m.revolute("C", left.end, coupler.end)
    m.revolute("D", right.end, coupler.start)
    m.trace("middle", coupler.at(1.0, 0.0))
    first, last = math.pi / 2, math.atan2(4.0, 3.0)  # from x = 0 to the middle; the other half is its mirror
    m.drive_angle("hand", left, lambda t: first + (last - first) * t)
    m.start_near(right=143, coupler=90)
    point = m.sweep(duration=1.0, steps=4000).point("middle")
    assert np.abs(point.y - 4).max() == pytest.approx(expected["max_abs_dev_from_y4_for_0<=x<=4"], rel=1e-6)
    np.testing.assert_allclose([point.x[0], point.y[0], point.x[-1], point.y[-1]], [0, 4, 2, 4], atol=1e-12)


def test_pantograph_scales_the_path_and_the_speed() -> None:
    k = _case("analytic_pantograph")["expected"]["k_example"]
    long, short = 0.25, 0.25 / k
    m = Mechanism("pantograph")
    near, far = m.bar("near", long), m.bar("far", long)  # O-A, A-P
    link, brace = m.bar("link", long - short), m.bar("brace", short)  # parallel to far and near
    crank = m.bar("crank", 0.03)
    m.revolute("O", m.ground.at(0, 0), near.start)
    m.revolute("A", near.end, far.start)
    m.revolute("B", near.at(short, 0), brace.start)
    m.revolute("C", far.at(short, 0), link.end)
    m.revolute("Q", brace.end, link.start)
    m.revolute("M", m.ground.at(0.12, 0.05), crank.start)
    m.revolute("K", crank.end, brace.end)
    m.drive_angle("motor", crank, constant_rate(2.0))
    m.trace("pen", far.end)
    m.trace("guide", crank.end)
    m.start_near(crank=0, near=70, far=-40, link=70, brace=-40)
    sol = m.sweep()
    pen, guide = sol.point("pen"), sol.point("guide")
    for field in RATES:
        np.testing.assert_allclose(getattr(pen, field), k * getattr(guide, field), atol=1e-11)


# -- PMKS -------------------------------------------------------------------------------------------------------


def _pmks(case: dict[str, Any]) -> Solution:
    """A model from the case's joints (named by letters, places at the start) and links."""
    place = {joint["id"]: np.array(joint["initial"]) for joint in case["joints"]}
    m = Mechanism(case["name"], gravity=None)
    origin: dict[str, tuple[Body, np.ndarray]] = {"ground": (m.ground, np.zeros(2))}
    for link in case["links"]:
        base = place[link["joints"][0]]
        origin[link["id"]] = m.body(link["id"]), base
        m.start_near(**{link["id"]: (float(base[0]), float(base[1]), 0.0)})

    def marker(link: str, at: np.ndarray, angle: float = 0.0) -> Marker:
        body, base = origin[link]
        return body.at(float(at[0] - base[0]), float(at[1] - base[1]), angle)

    for joint in case["joints"]:
        first, second = joint["links"]
        if joint["type"] == "R":
            m.revolute(joint["id"], marker(first, place[joint["id"]]), marker(second, place[joint["id"]]))
        else:
            axis = joint["guide_axis"]
            guide = marker("ground", place[joint["id"]], math.atan2(axis[1], axis[0]))
            m.pin_in_slot(joint["id"], guide, marker(first, place[joint["id"]]))
    for joint in case["joints"]:
        link = next(name for name in joint["links"] if name != "ground")
        m.trace(f"joint {joint['id']}", marker(link, place[joint["id"]]))
    for point in case["tracer_points"]:
        m.trace(f"point {point['id']}", marker(point["link"], np.array(point["initial"])))
    driver = case["drivers"][0]
    m.drive_angle("motor", origin[driver["link"]][0], constant_rate(driver["speed_rad_s"]))
    angles = np.array([row[1] for row in case["expected"][0]["rows"]])
    return m.sweep(times=(angles - angles[0]) / driver["speed_rad_s"])


@pytest.mark.parametrize(
    "name",
    ["pmks_teaching_four_bar", "pmks_teaching_slider_crank", "pmks_slider_crank_tracer", "pmks_steep_slider_crank"],
)
def test_pmks(name: str) -> None:
    case = _case(name)
    sol = _pmks(case)
    checked = 0
    for item in case["expected"][1:]:
        what, rows = item["quantity"], np.array([row[1:] for row in item["rows"]], float)
        if what.startswith("link "):
            view = sol.body(what.split()[1])
            got = np.stack([view.theta - view.theta[0], view.omega, view.alpha], axis=1)
        elif what in sol.mechanism.traces:
            got = _columns(sol.point(what), RATES)
        else:
            continue
        checked += 1
        for column, wanted in zip(got.T, rows.T, strict=True):
            np.testing.assert_allclose(column, wanted, rtol=1e-8, atol=1e-8 * max(1.0, np.abs(wanted).max()))
    assert checked >= 4


# -- FreeCAD's solver -------------------------------------------------------------------------------------------


def _ondsel(case: dict[str, Any]) -> Solution:
    """Bodies with frames at their centres of mass; the published part origins are traced points."""
    m = Mechanism(case["name"], gravity=tuple(case["gravity"]))
    bodies = {"ground": m.ground}
    for body in case["bodies"]:
        bodies[body["id"]] = m.body(body["id"], body["m"], (0.0, 0.0), body["J"])
        m.start_near(**{body["id"]: (*body["r"], math.degrees(body["phi"]))})
        offset = np.array(body["asmt_origin"]) - np.array(body["r"])
        c, s = math.cos(body["phi"]), math.sin(body["phi"])
        m.trace(body["id"], bodies[body["id"]].at(c * offset[0] + s * offset[1], -s * offset[0] + c * offset[1]))
    for joint in case["joints"]:
        (a, pa), (b, pb) = joint["a"], joint["b"]
        turn = math.atan2(joint["axis"][1], joint["axis"][0]) if "axis" in joint else 0.0
        i, j = bodies[a].at(pa[0], pa[1], turn), bodies[b].at(pb[0], pb[1], turn)
        m.revolute(joint["id"], i, j) if joint["type"] == "revolute" else m.prismatic(joint["id"], i, j)
    crank = bodies["Part1"]
    start = case["bodies"][0]["phi"]
    m.drive_angle("motor", crank, constant_rate(2 * math.pi, start))
    return m.sweep(times=[row[0] for row in case["expected"][0]["rows"]])


@pytest.mark.parametrize("name", ["ondsel_piston", "ondsel_crank_slider"])
def test_ondsel_motion_reactions_and_motor_torque(name: str) -> None:
    case = _case(name)
    sol = _ondsel(case)
    for item in case["expected"]:
        what, rows = item["quantity"], np.array(item["rows"])[:, 1:]
        if what.startswith("part "):
            view = sol.point(what.split()[1].rstrip(":"))
            got = _columns(view, ("x", "y", "vx", "vy", "omega", "ax", "ay", "alpha"))
            np.testing.assert_allclose(got, rows, atol=5e-9 * max(1.0, np.abs(rows).max()))
        elif what.startswith("Joint"):
            reaction = -sol.joint(what.split(":")[0]).reaction  # published: on the first body
            np.testing.assert_allclose(reaction, rows, atol=1e-6)
        else:
            np.testing.assert_allclose(-sol.driver("motor").torque, rows[:, 0], atol=1e-6)


# -- published runs under load, checked by energy ------------------------------------------------------------------


def test_exudyn_slider_crank_speed_at_each_published_angle() -> None:
    """One freedom: work of the constant torque equals kinetic energy, T = theta' ^2 T(theta) at unit speed.

    The published speeds come from a time integration at 1e-6, exact enough until 1 s.
    """
    case = _case("exudyn_slider_crank_matlab")
    rows = np.array([row for row in case["expected"][0]["rows"] if row[0] <= 1.0])
    m = Mechanism("exudyn", gravity=None)
    crank = m.bar("crank", 0.1, 0.2, inertia=case["bodies"][0]["J"])
    conrod = m.bar("conrod", 0.3, 0.2, inertia=case["bodies"][1]["J"])
    slider = m.body("slider", 0.4)
    m.revolute("O", m.ground.origin, crank.start)
    m.revolute("A", crank.end, conrod.start)
    m.revolute("B", conrod.end, slider.origin)
    m.prismatic("guide", m.ground.origin, slider.origin)
    m.drive_angle("unit", crank, constant_rate(1.0))
    m.start_near(crank=0, conrod=0)
    sol = m.sweep(times=np.concatenate([[0.0], rows[:, 1]]))
    speed = np.sqrt(case["forces"][0]["value"] * rows[:, 1] / sol.energy.kinetic[1:])
    np.testing.assert_allclose(speed, rows[:, 2], rtol=1e-4)


def test_iftomm_four_bars_keep_the_published_energy() -> None:
    """Kinetic plus potential energy of the published angles and speeds is that of the start, by our model."""
    case = _case("iftomm_a02_n_four_bar_n2")
    rows = np.array(case["expected"][0]["rows"])
    x, y, vx, vy = rows[:, 1:].T
    angle, speed = np.unwrap(np.arctan2(y, x)), x * vy - y * vx
    order = [0, 1, 2, 3]  # single poses, each driven through at unit speed
    total = []
    for k in order:
        m = Mechanism("a02", gravity=(0.0, -9.81))
        rods = [m.bar(f"rod{i}", 1.0, 1.0) for i in range(3)]
        couplers = [m.bar(f"coupler{i}", 1.0, 1.0) for i in range(2)]
        for i, rod in enumerate(rods):
            m.revolute(f"ground{i}", m.ground.at(i, 0), rod.start)
        for i, bar in enumerate(couplers):
            m.revolute(f"left{i}", rods[i].end, bar.start)
            m.revolute(f"right{i}", rods[i + 1].end, bar.end)
        m.drive_angle("unit", rods[0], constant_rate(1.0, angle[k] - 0.01))
        m.start_near(**{rod.name: math.degrees(angle[k]) for rod in rods}, **{bar.name: 0 for bar in couplers})
        sol = m.sweep(times=[0.0, 0.01])
        total.append(speed[k] ** 2 * sol.energy.kinetic[1] + sol.energy.potential[1])
    np.testing.assert_allclose(total, total[0], atol=1e-4)


# Joints of machines against published tables and closed forms: Geneva, rolling cart, V-engine.


# -- Geneva -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("row", _case("analytic_geneva")["expected"]["table"], ids=lambda row: str(row["slots"]))
def test_geneva_by_its_table(row: dict[str, float]) -> None:
    slots = int(row["slots"])
    entry = math.radians(row["motion_deg"]) / 2
    peak = math.radians(row["angle_of_alpha_max_deg"])
    start = -math.pi + 0.01
    near = 1e-7
    angles = np.sort(
        np.concatenate(
            [
                np.linspace(start, start + 2 * math.pi, 1001),
                [0, peak, -peak, -entry - near, -entry + near, entry - near],
            ]
        )
    )
    sol = geneva(slots, start=start).sweep(times=np.concatenate([[0.0], angles[1:] - start]))
    angle, wheel = sol.body("crank").theta, sol.body("wheel")
    lam = row["crank_over_centre"]
    driven = np.abs(angle) < entry
    square = 1 - 2 * lam * np.cos(angle) + lam**2
    speed = np.where(driven, lam * (np.cos(angle) - lam) / square, 0.0)
    acceleration = np.where(driven, -lam * (1 - lam**2) * np.sin(angle) / square**2, 0.0)
    np.testing.assert_allclose(wheel.omega, -speed, atol=1e-9)  # an external wheel turns against its crank
    np.testing.assert_allclose(wheel.alpha, -acceleration, atol=1e-8 * row["alpha_max_over_w1sq"])
    assert np.ptp(wheel.theta) == pytest.approx(2 * math.pi / slots, rel=1e-9)
    assert np.mean(~driven) == pytest.approx(row["dwell_fraction"], abs=0.01)
    at = {key: int(np.argmin(np.abs(angle - value))) for key, value in (("peak", peak), ("middle", 0.0))}
    assert abs(wheel.omega[at["middle"]]) == pytest.approx(row["wmax_over_w1"], rel=1e-9)
    assert abs(wheel.alpha[at["peak"]]) == pytest.approx(row["alpha_max_over_w1sq"], rel=1e-8)
    before, after = int(np.argmin(np.abs(angle + entry + near))), int(np.argmin(np.abs(angle + entry - near)))
    assert wheel.alpha[before] == 0.0 or abs(wheel.alpha[before]) < 1e-9
    assert abs(wheel.alpha[after]) == pytest.approx(row["alpha_at_entry_over_w1sq"], rel=1e-5)
    np.testing.assert_allclose(sol.joint("index").torque[~driven], 0.0, atol=1e-9)  # nothing accelerates in the dwell


def test_a_geneva_goes_on_turn_after_turn_and_needs_its_radius() -> None:
    sol = geneva(4, start=-2.0).sweep(duration=10 * math.pi, steps=3000)
    wheel = sol.body("wheel").theta
    assert wheel[-1] - wheel[0] == pytest.approx(-5 * math.pi / 2, abs=1e-9)
    m = Mechanism("geneva")
    crank, other = m.body("crank"), m.body("wheel")
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(0.1, 0), other.origin)
    m.geneva("index", crank.origin, other.origin, 4, 0.05)
    m.drive_angle("motor", crank, constant_rate(1.0))
    with pytest.raises(AssemblyError, match=r"geneva: geneva 'index': .* hit the slots.*0.0707107 m, not 0.05"):
        m.sweep()


# -- rolling ----------------------------------------------------------------------------------------------------


def _cart() -> Mechanism:
    """Two wheels hold the cart's height and tilt; one freedom is left."""
    m = Mechanism("cart", gravity=(0.0, -9.81))
    cart = m.body("cart", 20, (0, 0), 5)
    for name, x in (("driven", -0.3), ("free", 0.3)):
        wheel = m.body(name, 2, (0, 0), 0.5)
        m.revolute(f"{name} axle", cart.at(x, -0.1), wheel.origin)
        m.rolling_disc(f"{name} road", m.ground.origin, wheel.origin, 0.1)
    m.start_near(cart=(0.5, 0.2, 0), driven=(0.2, 0.1, 0), free=(0.8, 0.1, 0))
    return m


def _assert_cart(sol: Solution, rows: np.ndarray, position: float, velocity: float) -> None:
    for b, name in enumerate(("cart", "driven", "free")):
        view = sol.body(name)
        got = np.stack([view.x, view.y, view.theta], axis=1)
        np.testing.assert_allclose(got, rows[:, 1 + 3 * b : 4 + 3 * b], atol=position)
        got = np.stack([view.vx, view.vy, view.omega], axis=1)
        np.testing.assert_allclose(got, rows[:, 10 + 3 * b : 13 + 3 * b], atol=velocity)


def test_rolling_cart_of_nikravesh() -> None:
    rows = np.array(_case("nikravesh_cart_a_rolling")["expected"][0]["rows"])
    m = _cart()
    m.drive_relative_angle("motor", m.bodies["cart"], m.bodies["driven"], constant_rate(-2 * math.pi))
    assert (m.mobility().dof, m.mobility().redundant_rows) == (1, 0)
    sol = m.sweep(times=rows[:, 0])
    _assert_cart(sol, rows, 1e-11, 1e-11)
    weight = 9.81 * 24
    carried = sol.joint("driven road").fy + sol.joint("free road").fy
    np.testing.assert_allclose(carried, weight, rtol=1e-9)


def test_rolling_cart_of_nikravesh_on_its_motor() -> None:
    """The torque falls straight with the speed, so the cart nears its top speed as 1 - exp(-t / T)."""
    case = _case("nikravesh_cart_c_rolling")
    rows, limits = np.array(case["expected"][0]["rows"]), case["expected"][0]
    m = _cart()
    line = curve([-4 * math.pi, 0.0], [0.0, -20.0], "linear")
    m.motor("motor", m.bodies["cart"], m.bodies["driven"], line)
    sol = m.simulate(times=rows[:, 0], tolerance=1e-10)
    _assert_cart(sol, rows, limits["tol_abs_pos"], limits["tol_abs_vel"])
    top = 0.1 * 4 * math.pi
    constant = (24 + 2 * 0.5 / 0.1**2) * top / (20 / 0.1)  # inertia seen by the cart over torque / radius
    speed = top * (1 - np.exp(-sol.t / constant))
    np.testing.assert_allclose(sol.body("cart").vx, speed, atol=1e-8)
    np.testing.assert_allclose(sol.body("cart").x, 0.5 + top * sol.t - constant * speed, atol=1e-8)


# -- V-engine ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("row", _case("analytic_v_engine")["expected"]["table"], ids=lambda row: f"V{row['V']}")
def test_v_engine_shaking_force(row: dict[str, float]) -> None:
    """Harmonics of the force on the frame; the second one with the next terms of its series in r / l."""
    r, rod, mass, speed = 0.05, 0.2, 1.0, 10.0
    m = Mechanism("v_engine", gravity=None)
    crank = m.bar("crank", r)
    m.revolute("main", m.ground.origin, crank.start)
    half = math.radians(row["V"]) / 2
    for name, lean in (("left", half), ("right", -half)):
        axis = math.pi / 2 + lean
        conrod, piston = m.bar(f"{name} rod", rod), m.body(f"{name} piston", mass)
        m.revolute(f"{name} pin", crank.end, conrod.start)
        m.revolute(f"{name} wrist", conrod.end, piston.origin)
        m.prismatic(f"{name} bore", m.ground.at(0, 0, axis), piston.at(0, 0, axis))
        bottom = r * math.cos(axis), r * math.sin(axis)
        m.start_near(
            **{
                f"{name} rod": math.degrees(axis),
                f"{name} piston": ((rod + r) * bottom[0] / r, (rod + r) * bottom[1] / r, 0),
            }
        )
    m.drive_angle("motor", crank, constant_rate(speed, math.pi / 2))  # angle 0 is the middle of the V
    m.start_near(crank=90)
    steps = 256
    sol = m.sweep(duration=2 * math.pi / speed, steps=steps)
    pistons = [sol.body(f"{name} piston") for name in ("left", "right")]
    force = -mass * np.array([sum(view.ax for view in pistons), sum(view.ay for view in pistons)])
    harmonics = np.fft.rfft(force[:, :-1], axis=1) / steps * 2 / (mass * r * speed**2)
    n = rod / r
    second = 1 + 1 / (4 * n**2) + 15 / (128 * n**4) + 35 / (512 * n**6)  # of F0 / n
    assert harmonics[1, 1].real == pytest.approx(row["primary_vertical"], abs=1e-9)
    assert abs(harmonics[0, 1].imag) == pytest.approx(abs(row["primary_horizontal"]), abs=1e-9)
    assert harmonics[1, 2].real * n / second == pytest.approx(row["secondary_vertical"], abs=2e-5)
    assert abs(harmonics[0, 2].imag) * n / second == pytest.approx(abs(row["secondary_horizontal"]), abs=2e-5)


# The list of published answers names every file and a test that reads it.


TESTS = Path(__file__).parents[1]

ROWS = re.findall(r"^\| \[[^]]*\]\((\w+)\.json\) \| (.*) \|$", (FOLDER / "README.md").read_text(), re.MULTILINE)


def test_every_file_is_listed_once() -> None:
    assert sorted(name for name, _ in ROWS) == sorted(file.stem for file in FOLDER.glob("*.json"))


@pytest.mark.parametrize(("name", "tests"), ROWS, ids=[name for name, _ in ROWS])
def test_its_test_reads_it(name: str, tests: str) -> None:
    named = re.findall(r"`(test_\w+\.py)(?:::(\w+))?`", tests)
    assert named
    for file, function in named:
        sources = [source for path in TESTS.rglob(file) if name in (source := path.read_text())]
        assert len(sources) == 1, f"{name}.json is read by {len(sources)} files called {file}"
        [source] = sources
        functions = {node.name for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)}
        assert not function or function in functions
