"""Uses a page as people do, in any browser; what is not as it should be comes back in words."""

from __future__ import annotations

import csv
import io
import json
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from shared.contract import Motion, read_motion
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.browsers.browser import APP, FRAME, STATE, Browser, box, click, drag, fingers, press
from tools.fixtures.pins import dot, projected

# The curves that are shown as CSV: saved by the key and by the button, whole and with the numbers of data.json.


DOWNLOAD_SECONDS = 20


def tabled(browser: Browser, motion: Motion) -> Iterator[str]:
    """Yield what is wrong with the files that are saved."""
    joint = next(name for name in motion.joints if motion.joints[name].kind == "revolute")
    browser.ask(f"{APP}.store.set({{playing: false, selected: {{kind: 'joint', name: '{joint}'}}}})")
    browser.ask(FRAME)
    button = box(browser, ".choose button")
    ways = {
        "the key s": press("s"),
        "the button": click(button["left"] + button["width"] / 2, button["top"] + button["height"] / 2),
    }
    for way, actions in ways.items():
        for old in browser.saved().iterdir():
            old.unlink()  # some browsers write over what has the name, others find another name
        browser.act(actions)
        file = _new(browser.saved())
        if file is None:
            yield f"{way} saves no file"
            continue
        if not file.name.startswith(f"{motion.mechanism}-{joint}") or file.suffix != ".csv":
            yield f"{way} saves {file.name}"
        yield from (f"{way}: {fault}" for fault in _faults(file, motion, joint))


def _new(folder: Path) -> Path | None:
    end = time.monotonic() + DOWNLOAD_SECONDS
    while time.monotonic() < end:
        there = list(folder.iterdir())
        if len(there) == 1 and there[0].suffix == ".csv" and there[0].stat().st_size:  # on its way it has another name
            return there[0]
        time.sleep(0.1)
    return None


def _faults(file: Path, motion: Motion, joint: str) -> Iterator[str]:
    with file.open(newline="", encoding="utf-8") as stream:
        head, *rows = csv.reader(stream)
    numbers = np.array(rows, float)
    if head[0] != "time [s]" or numbers.shape != (len(motion.time), len(head)):
        yield f"{file.name} has {numbers.shape} numbers under {head}"
        return
    if not np.allclose(numbers[:, 0], motion.time, rtol=0, atol=1e-12):
        yield f"{file.name} has other times than data.json"
    wanted = {f"joint {joint} Reaction {axis} [N]": getattr(motion.joints[joint], f"f{axis}") for axis in "xy"}
    for name, values in wanted.items():
        if name not in head:
            yield f"{file.name} has no {name}, but {', '.join(head)}"
            continue
        top = float(np.abs(values).max())
        if not np.allclose(numbers[:, head.index(name)], values, rtol=1e-6, atol=1e-6 * top):
            yield f"{file.name} has other numbers than data.json under {name}"


# Uses a page by fingers: one turns, pans or selects, two pinch and move, one on a curve moves the machine.


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


WIDTH, HEIGHT = 1000, 620
PHONE = 520, 780
"""As narrow as windows of all these browsers become."""
PARTS = (0.0, 0.31, 0.62, 0.93)
"""Fractions of the motion, where pins are looked at."""
NEAR = 2.0
"""Pixels between a pin and where data.json has it."""
SECONDS = 60
COMPLAINTS = """<script>window.complaints = [];
addEventListener("error", (event) => complaints.push(`${event.message} ${event.error?.stack ?? ""}`));
addEventListener("unhandledrejection", (event) => complaints.push(String(event.reason?.stack ?? event.reason)));
addEventListener("securitypolicyviolation", ({ violatedDirective: rule, blockedURI }) =>
  complaints.push(`${rule}: ${blockedURI}`));
for (const kind of ["error", "warn"]) {
  const said = console[kind].bind(console);
  console[kind] = (...words) => { complaints.push(words.map(String).join(" ")); said(...words); };
}</script>
"""
"""Goes into a copy of the page before its own script."""


def listening(page: Path, copy: Path) -> Path:
    """A copy of the page that keeps what it complains of."""
    content = page.read_text("utf-8")
    copy.write_text(content.replace("<script", COMPLAINTS + "<script", 1), "utf-8")
    return copy


def use(browser: Browser, out: Out, page: Path, pictures: Path) -> Iterator[str]:
    """Return faults of the page of ``out``.

    ``page`` is its copy that listens, ``pictures`` a folder for what is seen.
    """
    motion = read_motion(out.motion)
    yield from _opened(browser, page)
    if browser.ask(STATE)["view"] != "3d" or not browser.ask(f"!!{APP}.stage.solid"):
        yield "the parts are not shown"
        return
    browser.ask(f"{APP}.store.set({{theme: 'dark', shown: {{}}, playing: false}})")
    stage = box(browser, ".scene")
    for view in ("3d", "2d"):
        for part in PARTS:
            yield from _pin(browser, out, motion, view, part, stage, pictures)
    yield from _driven(browser, motion)
    yield from _select_joints(browser, motion, stage)
    yield from tabled(browser, motion)
    yield from touched(browser, motion, stage)
    browser.ask(f"{APP}.store.set({{view: '3d', selected: null, theme: 'auto', shown: {{trails: true}}}})")
    browser.ask(FRAME)
    (pictures / "page.png").write_bytes(browser.picture())
    browser.open(page, *PHONE)
    yield from _mounted(browser)
    wide = browser.ask("[document.documentElement.scrollWidth, innerWidth]")
    if wide[0] > wide[1]:
        yield f"a page of {wide[1]} pixels is {wide[0]} wide"
    browser.ask(FRAME)
    (pictures / "phone.png").write_bytes(browser.picture())
    yield from browser.ask("complaints")


def use_flat(browser: Browser, page: Path, pictures: Path) -> Iterator[str]:
    """Faults of the page where there is no WebGL."""
    yield from _opened(browser, page)
    browser.ask(FRAME)
    seen = browser.ask(
        "({view: document.querySelector('.mbsd').dataset.view, notice: document.querySelector('.notice').textContent,"
        " segments: document.querySelector('.segmented').checkVisibility(),"
        " charts: document.querySelectorAll('.chart').length})"
    )
    (pictures / "flat.png").write_bytes(browser.picture())
    if seen["view"] != "2d" or seen["segments"] or "no WebGL" not in seen["notice"] or seen["charts"] < 1:
        yield f"without WebGL it shows {seen}"
    yield from browser.ask("complaints")


def _opened(browser: Browser, page: Path) -> Iterator[str]:
    browser.open(page, WIDTH, HEIGHT)
    yield from _mounted(browser)


def _mounted(browser: Browser) -> Iterator[str]:
    end = time.monotonic() + SECONDS
    while not browser.ask("!!window.mbsd?.app"):
        if time.monotonic() > end:
            said = browser.ask("[document.getElementById('mbsd').textContent.slice(0, 200), ...complaints]")
            raise UserError(f"the page does not start: {' '.join(said)}")
        time.sleep(0.1)
    browser.ask(FRAME)
    yield from ()


def _pin(
    browser: Browser, out: Out, motion: Motion, view: str, part: float, stage: dict[str, float], pictures: Path
) -> Iterator[str]:
    names = [name for name in motion.joints if motion.joints[name].kind == "revolute"]
    joint = names[int(part * len(names))]
    step = int(part * (len(motion.time) - 1))
    place = motion.joints[joint].x[step], motion.joints[joint].y[step]
    selected = f"{{kind: 'joint', name: '{joint}'}}"
    browser.ask(f"{APP}.store.set({{view: '{view}', time: {motion.time[step]!r}, selected: {selected}}})")
    browser.ask(FRAME)
    picture = pictures / f"{view}-{step}.png"
    corner = round(stage["left"]), round(stage["top"])
    area = (*corner, corner[0] + round(stage["width"]), corner[1] + round(stage["height"]))
    Image.open(io.BytesIO(browser.picture())).crop(area).save(picture)
    if view == "3d":
        wanted = projected(out, joint, place, stage)
    else:
        wanted = tuple(browser.ask(f"{APP}.stage.plane.paper.pixel({place[0]!r}, {place[1]!r})"))
        (ox, oy), scale = browser.ask(f"[{APP}.stage.plane.paper.pixel(0, 0), {APP}.stage.plane.paper.scale]")
        if np.hypot(ox + scale * place[0] - wanted[0], oy - scale * place[1] - wanted[1]) > 1e-6:
            yield "the plane is not to scale"
    try:
        pin = dot(picture)
    except AssertionError:
        yield f"{view}: nothing marks joint {joint} at {motion.time[step]} s ({picture})"
        return
    away = float(np.hypot(pin[0] - wanted[0], pin[1] - wanted[1]))
    if away > NEAR:
        yield f"{view}: joint {joint} at {motion.time[step]} s is {away:.1f} pixels from where data.json has it"


def _driven(browser: Browser, motion: Motion) -> Iterator[str]:
    """Scrub bar and keys."""
    start, end = motion.time[0], motion.time[-1]
    browser.ask(f"{APP}.store.set({{view: '2d', selected: null, time: {start!r}}})")
    bar = box(browser, ".bar .scrub")
    browser.act(click(bar["left"] + bar["width"] / 2, bar["top"] + bar["height"] / 2))
    if abs(browser.ask(STATE)["time"] - (start + end) / 2) > 0.02 * (end - start):
        yield f"a click on the middle of the scrub bar goes to {browser.ask(STATE)['time']} s"
    browser.ask("document.activeElement.blur()")
    wanted = (("Home", start), ("End", end), ("Home", start))
    for key, moment in wanted:
        browser.act(press(key))
        if browser.ask(STATE)["time"] != moment:
            yield f"{key} goes to {browser.ask(STATE)['time']} s"
    browser.act(press("ArrowRight"))
    stepped = browser.ask(STATE)["time"]
    if not start < stepped < start + 0.1 * (end - start):
        yield f"an arrow key goes to {stepped} s"
    browser.act(press("Space"))
    until = time.monotonic() + SECONDS
    while browser.ask(STATE)["time"] <= stepped and time.monotonic() < until:
        time.sleep(0.1)
    state = browser.ask(STATE)
    if not state["playing"] or state["time"] <= stepped:
        yield "Space does not play"
    browser.act(press("Space"))


def _select_joints(browser: Browser, motion: Motion, stage: dict[str, float]) -> Iterator[str]:
    """A click on a joint, a drag on its curve, arrows, help."""
    browser.act(press("Home"))
    browser.ask(FRAME)
    joint = next(name for name in motion.joints if motion.joints[name].kind == "revolute")
    place = motion.joints[joint].x[0], motion.joints[joint].y[0]
    x, y = browser.ask(f"{APP}.stage.plane.paper.pixel({place[0]!r}, {place[1]!r})")
    browser.act(click(stage["left"] + x, stage["top"] + y))
    if (browser.ask(STATE)["selected"] or {}).get("kind") != "joint":
        yield f"a click on joint {joint} selects {browser.ask(STATE)['selected']}"
    browser.ask(FRAME)
    over = box(browser, ".u-over")
    line = over["top"] + 20
    browser.act(drag([(over["left"] + part * over["width"], line) for part in (0.2, 0.5, 0.75)]))
    moment = motion.time[0] + 0.75 * (motion.time[-1] - motion.time[0])
    if abs(browser.ask(STATE)["time"] - moment) > 0.02 * (motion.time[-1] - motion.time[0]):
        yield f"a drag on a curve goes to {browser.ask(STATE)['time']} s instead of {moment} s"
    browser.act(press("r"))
    browser.ask(FRAME)
    if "reactions" not in browser.ask("document.querySelector('.legend').textContent"):
        yield "r shows no reactions"
    browser.act(press("?"))
    if "play, pause" not in browser.ask("document.querySelector('dialog[open]')?.textContent ?? ''"):
        yield "? shows no help"
    browser.act(press("Escape"))
    if browser.ask("!!document.querySelector('dialog[open]')"):
        yield "Escape does not close the help"
