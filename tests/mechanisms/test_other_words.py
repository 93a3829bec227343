"""Mechanisms of the gallery in other words: turned, mirrored, reordered, renamed, in other units.

`make hunt` does this for all of them, and for random mechanisms.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from tools.hunt import case
from tools.hunt.agreement import Words, compare_driven
from tools.hunt.outcome import AGREED, WRONG
from tools.hunt.simulating import RUNS
from tools.hunt.sweeping import SWEEPS
from tools.models import linkages
from tools.random_mechanisms.families import all_families
from tools.random_mechanisms.registry import loaded
from tools.random_mechanisms.similar import in_units, mirrored, renamed

WORDS = ("world turned and moved", "another order", "mirror image", "other units", "other names")
DERIVATIVES = "derivatives of the moved machine"
OUTLINES = ("gallery ratchet", "gallery escapement", "gallery cycloidal_drive")
"""Machines whose collisions take minutes in all words; tests/dynamics/test_outlines.py turns outlines."""
FEW = ("four_bar", "slider_crank", "planetary_gear", "double_pendulum", "toggle_clamp")


@pytest.mark.parametrize("name", FEW)
def test_results_do_not_depend_on_the_words(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for table in (RUNS, SWEEPS):
        for other in [key for key in table if key not in WORDS]:
            monkeypatch.delitem(table, other)
    outcomes = case.run(7, f"gallery {name}", every=True).outcomes
    assert {outcome.variation for outcome in outcomes} >= {*WORDS}
    assert [outcome for outcome in outcomes if outcome.state != AGREED] == []


@pytest.mark.parametrize("name", ["four_bar", "slider_crank", "double_pendulum"])
def test_derivatives_do_not_depend_on_the_words(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    _with_alone(DERIVATIVES, monkeypatch)
    outcomes = case.run(7, f"gallery {name}", every=True).outcomes
    assert {outcome.variation: outcome.state for outcome in outcomes}[DERIVATIVES] == AGREED


@pytest.mark.slow
def test_no_derivatives_of_the_gallery_depend_on_the_words(monkeypatch: pytest.MonkeyPatch) -> None:
    _with_alone(DERIVATIVES, monkeypatch)
    names = [name for name in all_families() if name.startswith("gallery ") and name not in OUTLINES]
    outcomes = [(name, outcome) for name in names for outcome in case.run(3, name, every=True).outcomes]
    assert [(name, outcome) for name, outcome in outcomes if outcome.state == WRONG] == []
    compared = [name for name, outcome in outcomes if outcome.variation == DERIVATIVES and outcome.state == AGREED]
    assert len(compared) > 10, compared


def _with_alone(variation: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for table in (RUNS, SWEEPS):
        for other in [key for key in table if key != variation]:
            monkeypatch.delitem(table, other)


@pytest.mark.slow
def test_no_mechanism_of_the_gallery_depends_on_the_words(monkeypatch: pytest.MonkeyPatch) -> None:
    for table in (RUNS, SWEEPS):
        for other in [key for key in table if key not in WORDS]:
            monkeypatch.delitem(table, other)
    names = [name for name in all_families() if name.startswith("gallery ") and name not in OUTLINES]
    assert len(names) > 40
    wrong = [(name, o) for name in names for o in case.run(3, name, every=True).outcomes if o.state == "wrong"]
    assert wrong == []


def four_bar(crank: float, coupler: float, tracer: tuple[float, float], mass: float) -> Mechanism:
    lengths, masses, law = (crank, coupler, 0.3), (mass, 0.3, 0.2), constant_rate(6.0)
    m = linkages.four_bar((0.4, 0.02), *lengths, (45, 90), masses=masses, law=law, traced=tracer)
    b, c = m.bodies["coupler"], m.bodies["rocker"]
    m.spring("pull", m.ground.at(0.0, 0.5), b.at(*tracer), stiffness=80.0, free_length=0.2, damping=0.4)
    m.torsion_spring("twist", m.ground, c, 0.3, damping=0.01, free_angle=0.7)
    return m


@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    crank=st.floats(0.06, 0.12),
    coupler=st.floats(0.34, 0.42),
    tracer=st.tuples(st.floats(-0.1, 0.3), st.floats(-0.2, 0.2)),
    mass=st.floats(0.01, 20.0),
    length=st.floats(1e-2, 1e3),
    other_mass=st.floats(1e-2, 1e3),
)
def test_random_linkages_with_springs(
    crank: float, coupler: float, tracer: tuple[float, float], mass: float, length: float, other_mass: float
) -> None:
    m = four_bar(crank, coupler, tracer, mass)
    first = m.sweep(steps=90)
    for words, other in (
        (Words(mirrored=True), mirrored(m)),
        (Words(length=length, mass=other_mass), in_units(m, length, other_mass)),
    ):
        assert other is not None
        verdict = compare_driven(first, other.sweep(steps=90), words)
        assert verdict.agrees, verdict.words
        assert verdict.compared > 80
    other = renamed(m)
    assert other is not None
    again = other.sweep(steps=90)
    assert np.array_equal(again.q, first.q)
    assert np.array_equal(again.wrench, first.wrench)


def test_the_comparison_finds_a_force_that_knows_its_side() -> None:
    m = four_bar(0.1, 0.38, (0.1, 0.1), 1.0)
    other = mirrored(m)
    assert other is not None
    other.change("twist", free_angle=0.7)
    assert not compare_driven(m.sweep(steps=90), other.sweep(steps=90), Words(mirrored=True)).agrees


def test_a_gallery_mechanism_is_hunted_as_it_is_shown() -> None:
    m, duration = loaded("double_pendulum")
    assert duration is not None
    assert "gallery double_pendulum" in all_families()
    assert len(m.bodies) == 3
