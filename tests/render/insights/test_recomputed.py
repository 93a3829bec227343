"""Numbers of insights against the same numbers computed another way, and the rules of ranking and words."""

from __future__ import annotations

import re
from string import Formatter

import msgspec
import numpy as np
import pytest

from render.insights import Insight, insights
from render.insights.causes import parts_of
from render.insights.insight import LANGUAGES, sentences
from render.insights.ranking import ANEW, WEIGHTS
from render.insights.seen import Seen
from render.insights.stops import fastest, stops, words_of
from shared.contract import Motion
from tools.models.motions import bouncing_ball, four_bar_motion

MOTION = four_bar_motion()


def of_kind(findings: list[Insight], kind: str) -> Insight:
    """Return the first insight of a kind."""
    return next(each for each in findings if each.kind == kind)


# -- causes ----------------------------------------------------------------------------------------------------------


def _without(motion: Motion, weight: bool) -> np.ndarray:
    """Return the reactions (n, 8) of the four-bar's four pins without weight, or without inertia, from equations of
    each bar about its own centre of mass.
    """
    names = ("crank", "coupler", "rocker")
    rows = []
    for k in range(0, len(motion.time), 30):
        matrix, right = np.zeros((9, 9)), np.zeros(9)
        for n, name in enumerate(names):
            body = motion.bodies[name]
            c, s = np.cos(body.theta[k]), np.sin(body.theta[k])
            arm = np.array([c * body.com[0] - s * body.com[1], s * body.com[0] + c * body.com[1]])
            centre = np.array([body.x[k], body.y[k]]) + arm
            spin, rise = body.omega[k], body.alpha[k]
            pull = np.array(
                [body.ax[k] - rise * arm[1] - spin**2 * arm[0], body.ay[k] + rise * arm[0] - spin**2 * arm[1]]
            )
            for j, pin in enumerate("ABCD"):
                joint = motion.joints[pin]
                if name not in joint.bodies:
                    continue
                sign = 1.0 if joint.bodies[1] == name else -1.0
                way = np.array([joint.x[k], joint.y[k]]) - centre
                matrix[3 * n : 3 * n + 3, 2 * j : 2 * j + 2] = sign * np.array([[1, 0], [0, 1], [-way[1], way[0]]])
            if not weight:
                right[3 * n : 3 * n + 2] = -body.mass * np.array(motion.gravity)
            else:
                right[3 * n : 3 * n + 3] = [*(body.mass * pull), body.inertia * rise]
        matrix[2, 8] = 1.0  # the motor turns the crank
        rows.append(np.linalg.solve(matrix, right)[:8])
    return np.array(rows)


def test_the_parts_of_a_reaction_are_those_of_the_balance_with_one_cause_alone() -> None:
    seen = Seen(MOTION)
    inertia, weight = _without(MOTION, weight=True), _without(MOTION, weight=False)
    for n, k in enumerate(range(0, len(MOTION.time), 30)):
        for j, pin in enumerate("ABCD"):
            joint = MOTION.joints[pin]
            whole = np.array([joint.fx[k], joint.fy[k]])
            parts = parts_of(seen, pin, k)
            assert parts["weight"] == pytest.approx(weight[n, 2 * j : 2 * j + 2] @ whole / (whole @ whole), abs=1e-6)
            assert parts["inertia"] == pytest.approx(inertia[n, 2 * j : 2 * j + 2] @ whole / (whole @ whole), abs=1e-6)


def test_no_cause_is_named_where_the_balance_does_not_give_the_reaction_back() -> None:
    false = msgspec.structs.replace(MOTION.joints["A"], fx=[2.0 * value for value in MOTION.joints["A"].fx])
    wrong = msgspec.structs.replace(MOTION, joints=MOTION.joints | {"A": false})
    assert parts_of(Seen(wrong), "A", 10) == {}


# -- forces and power ------------------------------------------------------------------------------------------------


def test_a_motor_at_its_peak_is_said_to_brake_where_its_power_is_negative() -> None:
    for sign in (1.0, -1.0):
        driver = MOTION.drivers["motor"]
        power = [sign * value for value in driver.power]
        motion = msgspec.structs.replace(MOTION, drivers={"motor": msgspec.structs.replace(driver, power=power)})
        each = of_kind(insights(motion), "effort_peak")
        k = int(np.abs(driver.effort).argmax())
        assert each.number == pytest.approx(driver.effort[k])
        assert each.start == motion.time[k]
        assert ("brakes" in each.sentence()) == (power[k] < 0)


def test_the_time_in_which_a_motor_brakes_is_that_of_its_negative_power() -> None:
    each, time = of_kind(insights(MOTION), "power_sign"), np.linspace(MOTION.time[0], MOTION.time[-1], 100001)
    power = np.interp(time, MOTION.time, MOTION.drivers["motor"].power)
    assert each.number == pytest.approx(np.mean(power < 0), abs=0.012)
    assert np.interp((each.start + each.end) / 2 % MOTION.time[-1], MOTION.time, MOTION.drivers["motor"].power) < 0


def test_the_largest_reaction_is_told_with_its_time() -> None:
    each = of_kind(insights(MOTION), "peak_cause")
    sizes = {name: np.hypot(joint.fx, joint.fy) for name, joint in MOTION.joints.items()}
    name = max(sizes, key=lambda key: sizes[key].max())
    assert each.joints == (name,)
    assert each.number == pytest.approx(sizes[name].max())
    assert each.start == pytest.approx(MOTION.time[int(sizes[name].argmax())])


# -- ranking and words -----------------------------------------------------------------------------------------------


def test_they_are_ranked_and_the_second_of_a_kind_counts_half() -> None:
    findings = insights(MOTION)
    telling = [each.telling for each in findings]
    assert telling == sorted(telling, reverse=True)
    seen: dict[str, int] = {}
    for each in findings:
        count = seen.get(each.kind, 0)
        seen[each.kind] = count + 1
        assert each.telling == pytest.approx(WEIGHTS[each.kind] * each.strength * ANEW**count)
        assert 0.0 <= each.strength <= 1.0


def test_every_kind_that_is_found_has_a_weight_and_every_template_a_sentence() -> None:
    sources = [path.read_text() for path in (LANGUAGES / "kinds").glob("*.py")]
    kinds = {kind for text in sources for kind in re.findall(r"insight\(\s*\"(\w+)\"", text)}
    assert kinds == set(WEIGHTS)


def test_every_language_has_the_same_sentences_with_the_same_names() -> None:
    tables = {path.stem: sentences(path.stem) for path in LANGUAGES.glob("*.toml")}
    fields = {
        language: {
            key: sorted({name for _, name, _, _ in Formatter().parse(text) if name}) for key, text in table.items()
        }
        for language, table in tables.items()
    }
    assert {"en", "de"} <= set(fields)
    assert all(named == fields["en"] for named in fields.values())


def test_stops_are_asked_for_by_name() -> None:
    asked = [words for each in stops(MOTION) for words in words_of(each)]
    assert {"rocker turns back", "motor", *MOTION.joints, fastest(MOTION)[0]} <= set(asked)
    assert "floor: impact" in [words for each in stops(bouncing_ball()) for words in words_of(each)]
    assert all(each.sentence(language) for each in stops(MOTION) for language in ("en", "de"))
