"""The hip thrust: its moments from equations of their own, from virtual work, and beside published ones."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import root

from mbsd import ModelError
from mbsd.machines.body.chain import Tempo
from mbsd.machines.body.figure import Figure
from mbsd.machines.body.hip_thrust import hip_thrust, placed_on_bench
from mbsd.machines.body.lift import Lift, lifted
from mbsd.machines.body.segments import DE_LEVA_WOMEN

G = np.array([0.0, -9.80665])
WHO, LOAD = Figure(), 65.0


@pytest.fixture(scope="module")
def lift() -> Lift:
    return lifted(hip_thrust(WHO, LOAD, pressure=0.03))


def test_the_back_stays_on_the_pad_and_the_foot_on_the_floor(lift: Lift) -> None:
    sol = lift.solution
    assert np.abs(sol.body("foot").theta).max() < 1e-12
    assert np.ptp(np.degrees(lift.flexion("hip"))) == pytest.approx(90.0, abs=1e-9)
    top = lift.bar[:, 1].argmax()
    assert sol.body("shank").theta[top] == pytest.approx(-math.pi / 2, abs=1e-12)  # upright, as was asked
    assert lift.bar[:, 1].min() > 0.225  # plates stay above the floor
    np.testing.assert_allclose(lift.pressure, 0.03, atol=1e-9)


def test_floor_and_pad_carry_weight_and_inertia(lift: Lift) -> None:
    total = sum(body.mass for body in lift.solution.mechanism.bodies.values())
    assert total == pytest.approx(WHO.mass + LOAD)
    wanted = -total * G - lift.solution.shaking().force
    np.testing.assert_allclose(lift.floor + lift.pad, wanted, atol=1e-8 * total * 9.8)


def test_the_moments_do_the_work_that_the_energy_takes(lift: Lift) -> None:
    """In a whole repetition none is left; on the way up what the centre of mass rises by."""
    work = np.sum([lift.power(joint) for joint in ("hip", "knee", "ankle")], axis=0)
    energy = lift.solution.energy.total
    up = lift.t <= 1.0 + 1e-12
    assert np.trapezoid(work[up], lift.t[up]) == pytest.approx(energy[up][-1] - energy[0], rel=2e-4)
    assert np.trapezoid(work, lift.t) == pytest.approx(0.0, abs=2e-3 * np.ptp(energy))


@pytest.mark.parametrize("grip", [0.0, 0.3])
@pytest.mark.parametrize("time", [0.05, 0.25, 0.8])
def test_moments_follow_from_equations_written_by_hand(grip: float, time: float) -> None:
    m = hip_thrust(WHO, LOAD, pressure=0.02, grip=grip)
    moments = lifted(m, steps=350)
    row = int(np.abs(moments.t - time).argmin())
    assert moments.t[row] == pytest.approx(time)
    wanted = by_hand(m, time, pressure=0.02, grip=grip)
    got = [moments.moment(joint)[row] for joint in ("hip", "knee", "ankle")]
    np.testing.assert_allclose(got, wanted[:3], atol=2e-3)
    np.testing.assert_allclose([*moments.floor[row], *moments.pad[row]], wanted[3:], atol=5e-3)


def by_hand(m, time: float, pressure: float, grip: float) -> np.ndarray:
    """Moments of hip, knee and ankle (N m), forces of floor and pad (N), from Newton's and Euler's laws of each body.

    Kinematics from closing the chain numerically, accelerations by differences.
    """
    tempo, step = Tempo(), 1e-3
    around = [kinematics(m, math.pi / 2 * (1 - tempo.part(time + k * step)[0])) for k in (-2, -1, 0, 1, 2)]
    weights = np.array([-1, 16, -30, 16, -1]) / (12 * step**2)
    now = around[2]
    acceleration = {
        key: sum(w * np.asarray(instant[key]) for w, instant in zip(weights, around, strict=True)) for key in now
    }
    mass = {name: body.mass for name, body in m.bodies.items()}
    inertia = {name: body.inertia for name, body in m.bodies.items()}
    x = np.array([math.cos(now["trunk"]), math.sin(now["trunk"])])
    y = np.array([-x[1], x[0]])
    pad_way = -y + grip * x  # n + grip s: out of the back to the front, and towards the head
    # Unknowns: hip, knee, ankle moments, floor x y, pad, then forces at ankle, knee, hip, bar on the later body.
    matrix, right = np.zeros((15, 14)), np.zeros(15)
    forces = {"floor": 3, "ankle": 6, "knee": 8, "hip": 10, "bar": 12}
    acts = {
        "foot": ([("floor", 1), ("ankle", -1)], {2: -1}),
        "shank": ([("ankle", 1), ("knee", -1)], {2: 1, 1: 1}),
        "thigh": ([("knee", 1), ("hip", -1)], {1: -1, 0: -1}),
        "trunk": ([("hip", 1), ("bar", -1)], {0: 1}),
        "barbell": ([("bar", 1)], {}),
    }
    places = now | {"at_floor": np.array([pressure, 0.0])}
    for row, (body, (joints, moments)) in enumerate(acts.items()):
        centre = np.asarray(now[f"{body}_com"])
        rows = slice(3 * row, 3 * row + 2)
        for joint, sign in joints:
            column = forces[joint]
            matrix[rows, column : column + 2] += sign * np.eye(2)
            arm = np.asarray(places[f"at_{joint}"]) - centre
            matrix[3 * row + 2, column : column + 2] += sign * np.array([-arm[1], arm[0]])
        for column, sign in moments.items():
            matrix[3 * row + 2, column] += sign
        if body == "trunk":
            arm = np.asarray(now["at_pad"]) - centre
            matrix[rows, 5] += pad_way
            matrix[3 * row + 2, 5] += arm[0] * pad_way[1] - arm[1] * pad_way[0]
        right[rows] = mass[body] * (acceleration[f"{body}_com"] - G)
        right[3 * row + 2] = inertia[body] * acceleration[body]
    solved, _, rank, _ = np.linalg.lstsq(matrix, right, rcond=None)
    assert rank == 14  # the barbell does not turn: its last row says nothing
    assert np.abs(matrix @ solved - right).max() < 1e-8
    return np.array([*solved[:3], *solved[3:5], *(solved[5] * pad_way)])


def kinematics(m, flexion: float) -> dict:
    """Angles (rad), joints and centres of mass (m) at a flexion of the hip (rad)."""
    place = placed_on_bench(WHO, 0.40, None, None, 0.0)
    edge, contact = place.edge, place.contact
    ankle = 1j * WHO.length("ankle")

    def points(shank: float, thigh: float) -> tuple[complex, complex, complex]:
        knee = ankle - WHO.length("shank") * np.exp(1j * shank)
        hip = knee - WHO.length("thigh") * np.exp(1j * thigh)
        return knee, hip, hip + contact * np.exp(1j * (thigh + math.pi - flexion))

    def gap(angles: np.ndarray) -> list[float]:
        off = points(*angles)[2] - edge
        return [off.real, off.imag]

    shank, thigh = root(gap, [-1.2, 0.5], tol=1e-13).x
    knee, hip, pad = points(shank, thigh)
    trunk = thigh + math.pi - flexion
    frames = {"foot": (ankle, 0.0), "shank": (knee, shank), "thigh": (hip, thigh), "trunk": (hip, trunk)}
    bar = hip + complex(0.10, -0.14) * np.exp(1j * trunk)
    out = {body: angle for body, (_, angle) in frames.items()} | {"barbell": 0.0}
    for body, (origin, angle) in frames.items():
        place_of = origin + complex(*m.bodies[body].com) * np.exp(1j * angle)
        out[f"{body}_com"] = np.array([place_of.real, place_of.imag])
    out["barbell_com"] = np.array([bar.real, bar.imag])
    for name, point in {"ankle": ankle, "knee": knee, "hip": hip, "bar": bar, "pad": pad}.items():
        out[f"at_{name}"] = np.array([point.real, point.imag])
    return out


def test_moments_are_in_the_bands_of_the_literature(lift: Lift) -> None:
    """Hip 2.5 .. 3.7 N m/kg at its peak, early, near 90 degrees of flexion, less on the way up, with a second peak;
    knee below hip, ankle near zero. Bezodis et al., ISBS 35 (2017) 184: 3.13 +- 0.48, two peaks; Brazil et al., PLoS
    ONE 16 (2021) e0249307. Knee of a leg 66 +- 33 N m: Otsuka et al., PLoS ONE 16 (2021) e0251418.
    """
    hip, knee, ankle = (lift.moment(joint) / WHO.mass for joint in ("hip", "knee", "ankle"))
    up = np.flatnonzero(lift.t <= 1.0)
    peak = up[hip[up].argmax()]
    assert 2.5 < hip[peak] < 3.7
    assert lift.t[peak] < 0.35
    assert math.degrees(lift.flexion("hip")[peak]) > 70
    falling = up[(lift.t[up] > lift.t[peak]) & (lift.t[up] < 0.55)]
    assert (np.diff(hip[falling]) < 0).all()
    assert hip[falling[-1]] < 0.5 * hip[peak]
    assert hip[falling[-1]] < hip[up[-1]] < 0.75 * hip[peak]  # two peaks, the first the higher one
    assert hip.min() > 0.5  # extensor throughout
    assert np.abs(knee).max() < 0.6 * hip.max()
    assert 33 < knee.max() * WHO.mass / 2 < 99
    assert np.abs(ankle).max() < 0.2 * hip.max()


def test_half_the_friction_changes_where_the_floor_must_hold() -> None:
    """The pad's friction takes what the shoes need not hold; without any they must hold most."""
    slip = []
    for grip in (0.0, 0.2, 0.4):
        lift = lifted(hip_thrust(WHO, LOAD, grip=grip), steps=72)
        slip.append(float((np.abs(lift.floor[:, 0]) / lift.floor[:, 1])[0]))
    assert slip[0] > slip[1] > slip[2]


def test_a_woman_from_another_table_lifts_as_well() -> None:
    who = Figure(1.65, 62.0, DE_LEVA_WOMEN)
    lift = lifted(hip_thrust(who, 60.0), steps=72)
    assert 2.0 < lift.moment("hip").max() / who.mass < 4.5
    work = lift.work("hip")
    assert work[0] > 0 > work[1]


@pytest.mark.parametrize(
    ("wishes", "message"),
    [
        ({"load": -5.0}, r"hip_thrust: load is -5 kg; it must be 0 kg or more"),
        ({"flexion": (140.0, 0.0)}, r"flexion is 140 degrees at the bottom; it must be from -30 to 120"),
        ({"flexion": (90.0,)}, r"flexion has 1 value; give degrees at the bottom and at the top"),
        ({"distance": 2.0}, r"the ankle is 2\.\d* m from the edge of the pad.*change distance, bench or flexion"),
        ({"pressure": 0.5}, r"the floor pushes 0\.5 m in front of the ankle, but the foot reaches from"),
        ({"bench": 2.0}, r"the knee is -1\.\d+ m over the edge.*lower bench"),
        ({"bar": (0.1, 0.9)}, r"the hand is .* m from the shoulder.*hold it elsewhere"),
        ({"tempo": None, "grip": math.inf}, r"grip"),
    ],
)
def test_impossible_lifts_are_refused(wishes: dict, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        hip_thrust(WHO, **wishes)


@pytest.mark.parametrize(
    ("wishes", "message"),
    [
        (
            {"tempo": Tempo(up=0.3)},
            r"hip_thrust: at t = 0\.\d+ s the (floor|pad) would have to pull by \d+.* more time",
        ),
        ({"grip": -4.0}, r"the (floor|pad) would have to pull by"),
    ],
)
def test_floor_and_pad_push_only(wishes: dict, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        lifted(hip_thrust(WHO, **wishes), steps=72)


@pytest.mark.parametrize(("phase", "seconds"), [("up", 0.0), ("down", -1.0), ("hold", -0.1)])
def test_a_phase_takes_time(phase: str, seconds: float) -> None:
    with pytest.raises(ModelError, match=f"tempo: {phase} is"):
        Tempo(**{phase: seconds})
