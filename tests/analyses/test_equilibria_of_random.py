"""Random mechanisms: those that something holds have an equilibrium, at which they stay; others are told why not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import EquilibriumError, Mechanism
from tools.random_mechanisms.linkages import linkage


def _loose_chain(seed: int, held: bool) -> Mechanism:
    """Bars that hang from a cart on a rail that is not level, with or without a spring to ground."""
    rng = np.random.default_rng(seed)
    m, slope = Mechanism("chain"), float(rng.uniform(0.05, 0.5) * rng.choice([-1, 1]))
    cart = m.body("cart", 1.0, inertia=0.1)
    m.prismatic("rail", m.ground.at(0, 0, slope), cart.origin)
    at = cart.at(0.1, -0.1)
    for k in range(int(rng.integers(1, 4))):
        bar = m.bar(f"bar{k}", float(rng.uniform(0.2, 1.0)), float(rng.uniform(0.2, 2.0)))
        m.revolute(f"pin{k}", at, bar.start)
        m.start_near(**{bar.name: float(rng.uniform(-180, 0))})
        at = bar.end
    if held:
        m.spring("spring", m.ground.at(0.3, 0.5), cart.origin, float(rng.uniform(20, 100)), free_length=0.3)
    return m


def _stays(m: Mechanism) -> None:
    rest = m.equilibrium()
    assert rest.stability == "stable"
    rest.start(m)
    sol = m.simulate(0.05, steps=2)
    assert np.abs(sol.v).max() < 1e-6


@pytest.mark.parametrize("seed", range(12))
def test_a_closed_linkage_rests_where_its_equilibrium_is(seed: int) -> None:
    _stays(linkage(seed, 1 + seed % 3, damping=False).m)


@pytest.mark.parametrize("seed", range(8))
def test_a_cart_rests_if_a_spring_holds_it_and_runs_away_if_not(seed: int) -> None:
    _stays(_loose_chain(seed, held=True))
    with pytest.raises(
        EquilibriumError, match=r"It runs away: .* m from its start, and on and on\. Hold it by a spring"
    ):
        _loose_chain(seed, held=False).equilibrium()


def test_runaways_may_have_an_unstable_equilibrium_which_is_named_and_found() -> None:
    """A block on a slope in a frame that turns: m w^2 x cos(slope)^2 = m g sin(slope) cos(slope)."""
    slope, rate = 0.3, 2.0
    m = Mechanism("centrifuge")
    block = m.body("block", 1.0, inertia=0.1)
    m.prismatic("rail", m.ground.at(0, 0, slope), block.at(0, 0, 0))
    m.rotating_frame("turns", rate)
    with pytest.raises(
        EquilibriumError, match=r"It runs away: .* equilibrium\(nearest=True\) also looks for an unstable"
    ):
        m.equilibrium()
    rest = m.equilibrium(nearest=True)
    along = 9.80665 * math.sin(slope) / rate**2
    assert rest.stability == "unstable"
    assert math.hypot(rest.body("block").x, rest.body("block").y) == pytest.approx(along)
