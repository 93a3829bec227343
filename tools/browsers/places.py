"""Words that ask a page for what it shows."""

from __future__ import annotations

from tools.engines.browser import Browser

APP = "window.mbsd.app"
STATE = f"(({{time, playing, selected, view, shown}}) => ({{time, playing, selected, view, shown}}))({APP}.store.state)"
FRAME = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))"


def box(browser: Browser, selector: str) -> dict[str, float]:
    """Where an element is: left, top, width, height (CSS pixels of the page)."""
    return browser.ask(
        f"(({{left, top, width, height}}) => ({{left, top, width, height}}))"
        f"(document.querySelector('{selector}').getBoundingClientRect())"
    )
