"""Uses a page by fingers: one turns, pans or selects, two pinch and move, one on a curve moves the machine."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence

import numpy as np

from shared.contract import Motion
from tools.browsers.browser import APP, FRAME, STATE, Browser, box, fingers

Place = tuple[float, float]
EVENTS = """((ways) => {
  const kept = [Element.prototype.setPointerCapture, Element.prototype.hasPointerCapture], held = new Map();
  Element.prototype.setPointerCapture = function (id) { held.set(id, this); };
  Element.prototype.hasPointerCapture = function (id) { return held.get(id) === this; };
  const send = (kind, k, [clientX, clientY]) => {
    const target = held.get(100 + k) ?? document.elementFromPoint(clientX, clientY);
    const button = kind === "pointermove" ? -1 : 0;
    const who = { pointerType: "touch", isPrimary: k === 0, pointerId: 100 + k, button };
    target.dispatchEvent(new PointerEvent(kind, { bubbles: true, cancelable: true, clientX, clientY, ...who }));
  };
  ways.forEach((way, k) => send("pointerdown", k, way[0]));
  for (let step = 1; step < ways[0].length; step++) ways.forEach((way, k) => send("pointermove", k, way[step]));
  ways.forEach((way, k) => send("pointerup", k, way.at(-1)));
  [Element.prototype.setPointerCapture, Element.prototype.hasPointerCapture] = kept;
  return 1;
})"""
"""Where a browser makes a mouse of fingers: the events that they would send, and the capture that comes with them."""


ON_A_PART = """((solid) => {
  const [width, height] = solid.size;
  for (let y = height / 2; y > 40; y -= 10)
    for (let x = 40; x < width - 140; x += 10) if (solid.thingAt(x, y)) return [x, y];
})"""


def touch(browser: Browser, *ways: Sequence[Place]) -> None:
    """Fingers go down together, each along its places (CSS pixels of the page), and up together."""
    if browser.touches:
        browser.act(fingers(*ways))
    else:
        browser.ask(f"{EVENTS}({json.dumps([[list(place) for place in way] for way in ways])})")
    browser.ask(FRAME)


def touched(browser: Browser, motion: Motion, stage: dict[str, float]) -> Iterator[str]:
    """Yield what fingers do wrongly."""
    middle = stage["left"] + stage["width"] / 2, stage["top"] + stage["height"] / 2
    yield from _plane(browser, motion, middle, stage)
    yield from _parts(browser, middle)
    yield from _curve(browser, motion)


def _plane(browser: Browser, motion: Motion, middle: Place, stage: dict[str, float]) -> Iterator[str]:
    browser.ask(f"{APP}.store.set({{view: '2d', playing: false, selected: null, time: {motion.time[0]!r}}})")
    browser.ask(f"({APP}.stage.home(), {FRAME})")
    paper = f"(({{zoom, pan}}) => [zoom, ...pan])({APP}.stage.plane.paper)"
    joint = next(name for name in motion.joints if motion.joints[name].kind == "revolute")
    x, y = browser.ask(f"{APP}.stage.plane.paper.pixel({motion.joints[joint].x[0]!r}, {motion.joints[joint].y[0]!r})")
    touch(browser, [(stage["left"] + x, stage["top"] + y)])
    if (browser.ask(STATE)["selected"] or {}).get("kind") != "joint":
        yield f"a tap on joint {joint} selects {browser.ask(STATE)['selected']}"
    # Where nothing is, a finger pans.
    empty = stage["left"] + 12, stage["top"] + 12
    touch(browser, _way(empty, (40, 30)))
    if not np.allclose(browser.ask(paper), [1, 40, 30], atol=1):
        yield f"a finger that goes 40, 30 pans the plane by {browser.ask(paper)[1:]}"
    browser.ask(f"({APP}.stage.home(), {FRAME})")
    touch(browser, *_pinch(middle, 30, 75))
    if abs(browser.ask(paper)[0] - 2.5) > 0.05:
        yield f"fingers 60 and then 150 pixels apart zoom the plane by {browser.ask(paper)[0]}"
    if browser.ask(STATE)["selected"] is None:
        yield "a pinch on the plane takes the selection away"
    before = browser.ask(paper)
    touch(browser, *(_way((middle[0] + side, middle[1]), (24, -16)) for side in (-40, 40)))
    if not np.allclose(np.subtract(browser.ask(paper), before), [0, 24, -16], atol=2):
        yield f"two fingers that go 24, -16 move the plane by {np.subtract(browser.ask(paper), before).tolist()}"
    browser.ask(f"({APP}.stage.home(), {FRAME})")


def _parts(browser: Browser, middle: Place) -> Iterator[str]:
    browser.ask(f"{APP}.store.set({{view: '3d', selected: null}})")
    browser.ask(f"({APP}.stage.home(), {FRAME})")
    camera = (
        f"(({{controls}}) => [controls.getAzimuthalAngle(), controls.getDistance(), ...controls.target.toArray()])"
        f"({APP}.stage.solid)"
    )
    first = np.array(browser.ask(camera))
    touch(browser, _way(middle, (60, 0)))
    turned = np.array(browser.ask(camera)) - first
    if abs(turned[0]) < 0.1 or np.abs(turned[1:]).max() > 1e-6:
        yield f"one finger turns the parts by {turned[0]} rad and moves them by {turned[1:].tolist()}"
    touch(browser, *_pinch(middle, 30, 60))
    nearer = browser.ask(camera)[1] / first[1]
    if not 0.3 < nearer < 0.8:
        yield f"a pinch to double brings the parts to {nearer} of the distance"
    if browser.ask(STATE)["selected"]:
        yield f"a pinch selects {browser.ask(STATE)['selected']}"
    before = np.array(browser.ask(camera))
    touch(browser, *(_way((middle[0] + side, middle[1]), (50, 0)) for side in (-40, 40)))
    moved = np.array(browser.ask(camera)) - before
    if abs(moved[0]) > 1e-3 or np.hypot(*moved[2:4]) < 0.01:
        yield f"two fingers turn the parts by {moved[0]} rad and move them by {moved[2:].tolist()}"
    # The finger that was down first is on a part, hardly moves and goes up there.
    browser.ask(f"({APP}.stage.home(), {FRAME})")
    scene = box(browser, ".scene")
    x, y = browser.ask(f"{ON_A_PART}({APP}.stage.solid)")
    place = scene["left"] + x, scene["top"] + y
    touch(browser, _way(place, (1, 0)), _way((place[0] + 60, place[1]), (30, 0)))
    if browser.ask(STATE)["selected"]:
        yield f"a pinch about the first finger selects {browser.ask(STATE)['selected']}"
    browser.ask(f"({APP}.stage.home(), {FRAME})")
    touch(browser, [place])
    if not browser.ask(STATE)["selected"]:
        yield "a tap on a part selects nothing"
    browser.ask(f"{APP}.store.set({{selected: null}})")


def _curve(browser: Browser, motion: Motion) -> Iterator[str]:
    over = box(browser, ".u-over")
    start, end = motion.time[0], motion.time[-1]
    places = [(over["left"] + part * over["width"], over["top"] + 20) for part in (0.2, 0.4, 0.6)]
    touch(browser, places)
    moment = start + 0.6 * (end - start)
    if abs(browser.ask(STATE)["time"] - moment) > 0.02 * (end - start):
        yield f"a finger on a curve goes to {browser.ask(STATE)['time']} s instead of {moment} s"


def _way(place: Place, by: Place) -> list[Place]:
    return [(place[0] + part * by[0], place[1] + part * by[1]) for part in (0, 0.5, 1)]


def _pinch(middle: Place, before: float, after: float) -> list[list[Place]]:
    return [_way((middle[0] + side * before, middle[1]), (side * (after - before), 0)) for side in (-1, 1)]
