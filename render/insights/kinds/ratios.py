"""Insights into ratios: of speeds that stay or change, and of copies that are to scale."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from render.insights.insight import Insight
from render.insights.seen import TURN, Array, Output, Seen, amount, body, insight, load, point
from shared.contract import ContactMotion, JointMotion

HELD = 1e-6
"""Part by which a ratio may change that is held."""
SLOW = 0.05
"""Part of the input's highest rate below which no ratio is formed."""


def ratios(seen: Seen) -> Iterator[Insight]:
    """Yield all insights of this chapter."""
    yield from speed_ratio(seen)
    for output in seen.outputs:
        yield from changing_ratio(seen, output)
    yield from difference(seen)
    yield from scale(seen)
    yield from tackle(seen)


def speed_ratio(seen: Seen) -> Iterator[Insight]:
    """Yield ratios that stay: of the input's turning to that of outputs, and of turning to sliding."""
    given = seen.input
    if given is None or given.unit != "rad" or not given.body or given.body not in seen.omega:
        return
    own = seen.omega[given.body]
    when = (float(seen.time[0]), float(seen.time[-1]))
    for output in seen.outputs:
        ratio = held_ratio(output.rate, own)
        if ratio is None:
            continue
        if output.slides:
            yield insight(
                "speed_ratio", TURN * abs(ratio), "m", when, 0.5, "ratio_rack", bodies=(given.body, output.body),
                crank=body(given.body), body=body(output.body), way=amount(TURN * abs(ratio), "m"),
            )  # fmt: skip
        elif abs(abs(ratio) - 1) > 1e-6:
            slower = abs(ratio) < 1
            factor = 1 / abs(ratio) if slower else abs(ratio)
            template = f"ratio_{'slower' if slower else 'faster'}{'_back' if ratio < 0 else ''}"
            yield insight(
                "speed_ratio", ratio, "", when, 0.75, template, bodies=(given.body, output.body),
                crank=body(given.body), body=body(output.body), factor=amount(factor, "times", 4),
            )  # fmt: skip
        else:
            yield insight(
                "mirror", ratio, "", when, 0.5, "as_fast_back" if ratio < 0 else "as_fast",
                bodies=(given.body, output.body), bodies_one=body(given.body), bodies_other=body(output.body),
            )  # fmt: skip
    yield from _planets(seen, own, given.body)


def _planets(seen: Seen, own: Array, crank: str) -> Iterator[Insight]:
    """Yield ratios of bodies that turn and are carried about, as planets are."""
    held = {output.body for output in seen.outputs} | {crank}
    for name, omega in seen.omega.items():
        if name in held or name in seen.pinned or np.ptp(seen.theta[name]) < TURN:
            continue
        ratio = held_ratio(omega, own)
        if ratio is not None and abs(ratio - 1) > HELD:
            yield insight(
                "speed_ratio", ratio, "", (float(seen.time[0]), float(seen.time[-1])), 0.45,
                "ratio_carried_back" if ratio < 0 else "ratio_carried", bodies=(crank, name), crank=body(crank),
                body=body(name), factor=amount(abs(ratio), "", 4),
            )  # fmt: skip


def held_ratio(rate: Array, own: Array) -> float | None:
    """Return the ratio of two rates if it never changes."""
    top = float(np.abs(own).max(initial=0.0))
    if top <= 0:
        return None
    ratio = float(rate @ own / (own @ own))
    size = float(np.abs(rate).max())
    return ratio if size > 0 and float(np.abs(rate - ratio * own).max()) < HELD * size else None


def changing_ratio(seen: Seen, output: Output) -> Iterator[Insight]:
    """Yield how much faster an output is at its best than a crank that turns, or where a lever gains most."""
    given = seen.input
    if given is None or given.rate is None:
        return
    own = np.abs(given.rate)
    moves = own > SLOW * float(own.max())
    if not moves.any() or held_ratio(output.rate, given.rate) is not None:
        return
    ratio = np.where(moves, np.abs(output.rate) / np.maximum(own, 1e-300), 0.0)
    k = int(np.argmax(ratio >= ratio.max() * (1 - 1e-9)))
    when = (float(seen.time[k]), float(seen.time[k]))
    same_kind = (given.unit == "m") == output.slides
    if given.turns and not output.slides:
        whole = abs(float(output.value[-1] - output.value[0])) > TURN - 1e-6
        if ratio[k] > 1 or whole:
            yield insight(
                "speed_peak", ratio[k], "", when, 0.2 + 0.2 * ratio[k], bodies=(given.body, output.body),
                body=body(output.body), crank=body(given.body), ratio=amount(ratio[k], "times"),
                angle=amount(seen.angle_at(when[0]), "place"),
            )  # fmt: skip
        return
    if given.turns or not same_kind or len(seen.crossings(output.rate[moves])) > len(seen.crossings(given.rate[moves])):
        return
    least = float(ratio[moves].min())
    if ratio[k] > 1.3 * least:
        template = "ratio_changes_lift" if output.slides else "ratio_changes"
        low = float(seen.time[moves][int(ratio[moves].argmin())])
        yield insight(
            "changing_ratio", ratio[k], "", when, 0.4 + 0.1 * min(ratio[k] / max(least, 1e-3), 5), template,
            bodies=(given.body, output.body), joints=(given.name,), body=body(output.body), input=load(given.name),
            most=amount(ratio[k], "", 3), least=amount(least, "", 2), at=amount(when[0], "s"), low=amount(low, "s"),
        )  # fmt: skip


def difference(seen: Seen) -> Iterator[Insight]:
    """Yield how much further one of two mirrored outputs turns than the other, as the wheels of a car do."""
    for mirrored, other in combinations([each for each in seen.outputs if not each.slides], 2):
        first, second = (each.value - each.value[0] for each in (mirrored, other))
        ends = (float(first.max()), float(-first.min())), (float(-second.min()), float(second.max()))
        if np.abs(np.subtract(*ends)).max() > 1e-4 * max(ends[0]) or abs(ends[0][0] - ends[0][1]) < 0.02 * max(ends[0]):
            continue
        k = int(np.abs(first).argmax())
        most, least = abs(float(first[k])), abs(float(second[k]))
        yield insight(
            "difference", most / least, "", seen.moment_of(k), 0.8, bodies=(mirrored.body, other.body),
            body=body(mirrored.body), other=body(other.body), most=amount(most, "deg"), least=amount(least, "deg"),
        )  # fmt: skip


def scale(seen: Seen) -> Iterator[Insight]:
    """Yield pairs of points of which one draws what the other draws, to scale."""
    for a, b in combinations(seen.motion.points, 2):
        first, second = (
            np.array(seen.motion.points[name].x) + 1j * np.array(seen.motion.points[name].y) for name in (a, b)
        )
        drawn, copy = first - first.mean(), second - second.mean()
        if min(np.abs(drawn).max(), np.abs(copy).max()) < 1e-3 * seen.size:
            continue
        factor = np.vdot(drawn, copy) / np.vdot(drawn, drawn)
        size = abs(factor)
        if np.abs(copy - factor * drawn).max() > 1e-6 * np.abs(copy).max() or abs(size - 1) < 1e-6:
            continue
        if np.ptp(np.angle(drawn)) < 0.5:  # along one line anything is to scale
            continue
        small, large = (a, b) if size > 1 else (b, a)
        ratio = max(size, 1 / size)
        yield insight(
            "scale", ratio, "", (float(seen.time[0]), float(seen.time[-1])), 0.9, bodies=(), joints=(small, large),
            small=point(small), large=point(large), ratio=amount(ratio, "times"),
        )  # fmt: skip


def tackle(seen: Seen) -> Iterator[Insight]:
    """Yield what cables do: how much farther one thing slides than another, and how hard their strands pull."""
    connections: dict[str, JointMotion | ContactMotion] = {**seen.motion.joints, **seen.motion.contacts}
    spans = {name: each for name, each in connections.items() if each.shape is not None and each.shape.clockwise}
    if not spans:
        return
    whole = (float(seen.time[0]), float(seen.time[-1]))
    for pair in combinations([each for each in seen.outputs if each.slides], 2):
        farther, nearer = sorted(pair, key=lambda each: -each.travel)
        ratio = held_ratio(farther.rate, nearer.rate)
        if ratio is not None and abs(abs(ratio) - 1) > HELD:
            yield insight(
                "speed_ratio", abs(ratio), "", whole, 0.9, "slides_farther", bodies=(farther.body, nearer.body),
                body=body(farther.body), other=body(nearer.body), factor=amount(abs(ratio), "times", 4),
            )  # fmt: skip
    pulls = {name: np.hypot(each.fx, each.fy) for name, each in spans.items()}
    most = max(pulls, key=lambda name: float(pulls[name].max()))
    least = min(pulls, key=lambda name: float(pulls[name].min()))
    k = int(pulls[most].argmax())
    yield insight(
        "cable", float(pulls[most][k]), "N", seen.moment_of(k), 0.4, joints=(most,), cable=load(most),
        most=amount(pulls[most][k], "N"), least=amount(pulls[least].min(), "N"), at=amount(seen.time[k], "s"),
    )  # fmt: skip
