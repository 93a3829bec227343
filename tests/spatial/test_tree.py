"""Both formulations of simulations in space agree on motion and reactions, for every kind and for random mechanisms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd.base.errors import ModelError
from mbsd.spatial import Mechanism, constant_rate, harmonic
from mbsd.spatial.model.force import FORCE_KINDS
from mbsd.spatial.model.joint import KINDS
from mbsd.spatial.model.rotation import rotation_matrix
from mbsd.spatial.results.solution import Solution
from tests.spatial import machines

FINE = 1e-12
IN_TREES = ("fixed", "revolute", "prismatic", "cylindrical", "universal", "spherical", "screw")


def both(m: Mechanism, duration: float, tolerance: float = FINE, steps: int = 8) -> tuple[Solution, Solution]:
    """Return the same simulation in tree and in reference coordinates."""
    tree, reference = (
        m.simulate(duration=duration, steps=steps, tolerance=tolerance, formulation=name)
        for name in ("tree", "reference")
    )
    return tree, reference


def assert_same(a: Solution, b: Solution, within: float = 1e-10) -> None:
    """Compare poses, velocities, accelerations, reactions and efforts, relative to the largest."""
    for name in list(a.mechanism.bodies)[1:]:
        first, second = a.body(name), b.body(name)
        for part in ("place", "rotation", "velocity", "w", "acceleration", "alpha"):
            x, y = getattr(first, part), getattr(second, part)
            assert np.abs(x - y).max() <= within * max(1.0, np.abs(y).max()), (name, part)
    for name in a.mechanism.joints:
        for part in ("force", "moment"):
            x, y = getattr(a.joint(name), part), getattr(b.joint(name), part)
            assert np.abs(x - y).max() <= 10 * within * max(1.0, np.abs(b._whole.wrench).max()), (name, part)
    for name in a.mechanism.drivers:
        x, y = a.driver(name).effort, b.driver(name).effort
        assert np.abs(x - y).max() <= 10 * within * max(1.0, np.abs(y).max()), name
    assert np.allclose(a.work, b.work, rtol=0, atol=10 * within * max(1.0, np.abs(b.energy.kinetic).max()))


def two_bodies(seed: int = 3) -> Mechanism:
    """Return two bodies that fall, each with three unequal moments in axes of its own."""
    random = np.random.default_rng(seed)
    m = Mechanism("two bodies", gravity=(0, 1.0, -9.81))
    for name in ("first", "second"):
        axes = rotation_matrix(random.standard_normal(4))
        m.body(
            name, random.uniform(0.5, 2.0), com=random.uniform(-0.3, 0.3, 3), at=random.uniform(-0.3, 0.3, 3),
            inertia=axes @ np.diag(random.uniform(0.2, 0.3, 3)) @ axes.T, orientation=random.standard_normal(4),
        )  # fmt: skip
    m.start_moving({"first": (0.3, 0.2, -0.4), "second": (0.1, -0.5, 0.3)})
    return m


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
@pytest.mark.parametrize("kind", [name for name, kind in KINDS.items() if not kind.driven])
def test_every_joint_moves_alike_in_both_formulations(kind: str) -> None:
    m = two_bodies()
    KINDS[kind].example(m, *list(m.bodies.values())[1:])
    assert_same(*both(m, 0.3))


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
@pytest.mark.parametrize("kind", [name for name, kind in FORCE_KINDS.items() if kind.friction_of is None])
def test_every_force_acts_alike_in_both_formulations(kind: str) -> None:
    m = two_bodies()
    first, second = list(m.bodies.values())[1:]
    m.spherical("ball", m.ground, first, at=(0.1, 0.1, 0.1))
    FORCE_KINDS[kind].example(m, first, second)
    assert_same(*both(m, 0.3))


@pytest.mark.parametrize(
    "build",
    [
        machines.slider_crank,
        machines.four_link,
        machines.bennett,
        machines.sarrus,
        machines.bricard,
        lambda: machines.hooke_joint(0.6),
        lambda: machines.hooke_pair(0.4, True),
    ],
)
def test_loops_and_redundant_joints_move_alike(build) -> None:
    tree, reference = both(build(), 0.7)
    assert_same(tree, reference)
    assert (tree.formulation, reference.formulation) == ("tree", "reference")
    assert tree.stats.position_residual < 1e-11


@pytest.mark.parametrize("kind", ["revolute", "cylindrical", "prismatic", "screw"])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("against", [False, True])
def test_joints_may_be_written_from_either_side_and_with_axes_against_each_other(kind, turned, against) -> None:
    m = two_bodies()
    first, second = list(m.bodies.values())[1:]
    m.universal("cross", first, m.ground, at=(0.2, 0.1, 0), first=(1, 0, 1), second=(0, 1, 0))
    place, axis = np.array([0.4, -0.1, 0.2]), np.array([1.0, 2.0, -1.0])
    markers = []
    for body, sign in ((first, 1.0), (second, -1.0 if against else 1.0)):
        own = body.rotation.T
        markers.append(body.marker(own @ (place - body.place), sign * own @ axis, own @ [1.0, 0, 0]))
    args = {"lead": 0.2} if kind == "screw" else {}
    getattr(m, kind)("joint", *(markers[::-1] if turned else markers), **args)
    m.velocities.clear()
    m.start_moving({"joint": 2.0})
    tree, reference = both(m, 0.4)
    assert_same(tree, reference)
    if kind != "prismatic":
        assert np.allclose(tree.joint("joint").turn, reference.joint("joint").turn, rtol=0, atol=1e-9)


def test_driven_turns_and_slides_are_coordinates_of_the_tree() -> None:
    m = Mechanism("drivers")
    arm = m.rod("arm", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.05)
    boom = m.rod("boom", (1, 0, 0), (2, 0, 0), mass=1.0, radius=0.05)
    m.revolute("hinge", arm, m.ground, at=(0, 0, 0), axis=(0, 1, 1))
    m.cylindrical("bush", arm, boom, at=(1, 0, 0), axis=(1, 0, 0))
    m.drive_turn("motor", "hinge", constant_rate(9.0))
    m.drive_slide("jack", "bush", harmonic(0.1, 3.0))
    tree, reference = both(m, 2.0)
    assert_same(tree, reference, 1e-9)
    assert tree.joint("hinge").turn[-1] == pytest.approx(18.0, abs=1e-10)
    assert len(tree._whole.lam[0]) == len(reference.lam[0])


def test_gears_of_a_tree_count_their_turns() -> None:
    m = Mechanism("gears", gravity=None)
    for k, x in enumerate((0.0, 0.2)):
        wheel = m.disc(f"wheel {k}", (x, 0, 0), (0, 0, 1), radius=0.05, mass=1.0, thickness=0.01)
        m.revolute(f"shaft {k}", *((m.ground, wheel) if k else (wheel, m.ground)), at=(x, 0, 0), axis=(0, 0, 1))
    m.gear_pair("teeth", "shaft 0", "shaft 1", teeth=(20, 30))
    m.start_near({"shaft 0": 500.0})
    m.start_moving({"shaft 0": 30.0})
    for sol in both(m, 2.0, 1e-10):
        assert sol.joint("shaft 0").turn[-1] - sol.joint("shaft 0").turn[0] == pytest.approx(60.0, abs=1e-6)
        assert abs(sol.joint("shaft 1").turn[-1] - sol.joint("shaft 1").turn[0]) == pytest.approx(40.0, abs=1e-6)
        assert sol.stats.position_residual < 1e-9


def random_mechanism(seed: int, bodies: int, loops: int) -> Mechanism:
    """Return a random tree of joints of all kinds, and joints that close loops in it; some bodies may float."""
    random = np.random.default_rng(seed)
    m = Mechanism("random", gravity=random.uniform(-5, 5, 3))
    names = ["ground"]
    for k in range(bodies):
        axes = rotation_matrix(random.standard_normal(4))
        m.body(
            f"body {k}", random.uniform(0.5, 2.0), com=random.uniform(-0.5, 0.5, 3), at=random.uniform(-0.5, 0.5, 3),
            inertia=axes @ np.diag(random.uniform(0.2, 0.3, 3)) @ axes.T, orientation=random.standard_normal(4),
        )  # fmt: skip
        before = names[random.integers(len(names))]
        names.append(f"body {k}")
        pair = [before, f"body {k}"] if random.integers(2) else [f"body {k}", before]
        if random.uniform() < 0.9:
            join(m, random, random.choice(IN_TREES), f"joint {k}", pair)
    for k in range(loops):
        pair = [str(name) for name in random.choice(names, 2, replace=False)]
        join(m, random, random.choice(["distance", "point_on_plane", "spherical", "parallel"]), f"loop {k}", pair)
    m.start_moving({f"body {k}": random.uniform(-1, 1, 3) for k in range(bodies)})
    return m


def join(m: Mechanism, random: np.random.Generator, kind: str, name: str, pair: list[str]) -> None:
    """Add a joint of a kind at a random place of the design."""
    at, axis = random.uniform(-1, 1, 3), random.standard_normal(3)
    if kind == "universal":
        m.universal(name, *pair, at=at, first=axis, second=np.cross(axis, random.standard_normal(3)))
    elif kind == "distance":
        m.distance(name, *pair, start=at, end=at + axis)
    elif kind in ("fixed", "spherical"):
        getattr(m, kind)(name, *pair, at=at)
    else:
        getattr(m, kind)(name, *pair, at=at, axis=axis, **({"lead": 0.5} if kind == "screw" else {}))


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
@settings(max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), bodies=st.integers(1, 6), loops=st.integers(0, 2))
def test_random_trees_and_loops_move_alike_and_keep_their_energy(seed: int, bodies: int, loops: int) -> None:
    m = random_mechanism(seed, bodies, loops)
    tree, reference = both(m, 0.2, steps=3)
    total = tree.energy.total
    assert np.ptp(total) < 1e-9 * max(1.0, np.abs(tree.energy.kinetic).max())
    if reference.mobility.singular:
        return
    assert_same(tree, reference, 1e-8)


@settings(max_examples=10)
@given(seed=st.integers(0, 2**32 - 1))
def test_what_floats_keeps_its_momentum(seed: int) -> None:
    """A free tree without gravity: momentum, and angular momentum about the origin."""
    random = np.random.default_rng(seed)
    m = two_bodies(seed)
    m.gravity = None
    kind = random.choice([name for name in IN_TREES if name != "fixed"])
    join(m, random, str(kind), "joint", ["second", "first"])
    m.start_moving({"first": random.uniform(-3, 3, 3), "second": random.uniform(-3, 3, 3)})
    m.velocities.pop("second")
    sol = m.simulate(duration=1.0, steps=5, tolerance=1e-11, formulation="tree")
    momentum, spin = np.zeros((6, 3)), np.zeros((6, 3))
    for body in list(m.bodies.values())[1:]:
        centre, frame = sol.place(body.marker(body.com)), sol.body(body.name)
        momentum += body.mass * centre.velocity
        inertia = frame.rotation @ np.array(body.inertia) @ np.swapaxes(frame.rotation, 1, 2)
        spin += body.mass * np.cross(centre.place, centre.velocity) + np.einsum("tij,tj->ti", inertia, frame.w)
    assert np.allclose(momentum, momentum[0], rtol=0, atol=1e-9)
    assert np.allclose(spin, spin[0], rtol=0, atol=1e-9)


def test_bricards_loop_passes_the_poses_at_which_its_rows_depend() -> None:
    """Rows in use must change on the way; two turns of the loop keep the energy."""
    m = machines.bricard()
    m.gravity = (0.0, -9.81, 0.0)
    sol = m.simulate(duration=10.0, steps=40, tolerance=1e-10, formulation="tree")
    assert np.ptp(sol.energy.total) < 1e-7
    assert sol.stats.position_residual < 1e-10
    assert np.abs(sol.joint("hinge 0").force).max() < 1e3


def test_turns_far_from_zero_and_places_far_from_the_origin_cost_few_digits() -> None:
    tips = []
    for shift in (0.0, 1e3):
        m = Mechanism("far")
        before = m.ground
        for k in range(4):
            start, end = (shift + 0.1 * k, shift, 0), (shift + 0.1 * k + 0.1, shift, 0)
            bar = m.rod(f"bar {k}", start, end, mass=0.1, radius=0.01)
            m.universal(f"joint {k}", before, bar, at=start, first=(0, 1, 0), second=(0, 0, 1))
            before = bar
        m.trace("tip", before, at=(shift + 0.4, shift, 0))
        sol = m.simulate(duration=0.5, steps=4, tolerance=1e-11, formulation="tree")
        tips.append(sol.point("tip").place - [shift, shift, 0])
    assert np.allclose(*tips, rtol=0, atol=1e-10)


def test_the_quicker_formulation_is_chosen() -> None:
    """Trees and loops go by the tree, what flies free and long chains that are tied at every joint do not."""
    m = two_bodies()
    assert m.simulate(duration=0.01, steps=1).formulation == "reference"
    m.revolute("hinge", m.ground, m.bodies["first"], at=(0, 0, 0), axis=(0, 0, 1))
    m.spherical("ball", m.bodies["first"], m.bodies["second"], at=(0, 0, 1))
    assert m.simulate(duration=0.01, steps=1).formulation == "tree"
    assert machines.bricard().simulate(duration=0.01, steps=1).formulation == "tree"
    net = Mechanism("net")
    before = [net.ground, net.ground]
    for k in range(40):
        ends = [[(0.1 * side, 0, -0.1 * (k + low)) for low in (0, 1)] for side in (0, 1)]
        bars = [net.rod(f"bar {k} {side}", *ends[side], mass=0.1, radius=0.01) for side in (0, 1)]
        for side in (0, 1):
            at = ends[side][0]
            net.universal(f"joint {k} {side}", before[side], bars[side], at=at, first=(1, 0, 0), second=(0, 1, 0))
        net.distance(f"tie {k}", *bars, start=ends[0][1], end=ends[1][1])
        before = bars
    assert net.simulate(duration=0.001, steps=1, tolerance=1e-4).formulation == "reference"


def test_an_unknown_formulation_is_refused() -> None:
    with pytest.raises(ModelError, match="no formulation 'tre', did you mean 'tree'"):
        machines.bricard().simulate(duration=1.0, formulation="tre")
    assert math.isfinite(machines.bricard().simulate(duration=0.1).q[-1, -1])
