"""Uses a page as people do, in any browser; what is not as it should be comes back in words."""

from __future__ import annotations

import io
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from shared.contract import Motion, read_motion
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.browsers.browser import APP, FRAME, STATE, Browser, box, click, drag, press
from tools.browsers.table import tabled
from tools.browsers.touch import touched
from tools.fixtures.pins import dot, projected

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
    """Faults of the page of ``out``; ``page`` is its copy that listens, ``pictures`` a folder for what is seen."""
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
    yield from _asked(browser, motion, stage)
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


def _asked(browser: Browser, motion: Motion, stage: dict[str, float]) -> Iterator[str]:
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
