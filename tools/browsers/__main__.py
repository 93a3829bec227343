"""``python -m tools.browsers``: use the page in Firefox and in Safari's engine, from the disk.

--name four_bar,pendulum   the pages of these mechanisms, which make view-<name> has made; without it a small four-bar
--only firefox             in this browser alone: firefox, webkit

It looks at pins, scrubs, clicks, drags and types, in a phone's width and without WebGL, and ends with 1 if anything is
not as it should be or a browser is missing. Pictures of what was seen are in out/browsers/.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from shared.stage.console import run_cli, say, warn
from shared.stage.errors import UserError
from shared.stage.paths import Out, mechanism_name, out_root
from shared.system import missing
from tools.browsers.browser import screen
from tools.browsers.firefox import Firefox
from tools.browsers.use import listening, use, use_flat
from tools.browsers.webkit import WebKit

BROWSERS = {"firefox": (Firefox, "firefox"), "webkit": (WebKit, "WebKitWebDriver")}


def main() -> int:
    """Use every page in every browser and say what was wrong; 1 if anything was."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.browsers", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--name", default="")
    parser.add_argument("--only", choices=["", *BROWSERS], default="")
    asked = parser.parse_args()
    browsers = [asked.only] if asked.only else list(BROWSERS)
    programs = {name: _program(BROWSERS[name][1]) for name in browsers}
    hidden = _program("Xvfb")
    pictures = out_root() / "browsers"
    faults = 0
    with tempfile.TemporaryDirectory(prefix="mbsd-browsers-") as folder, screen(hidden) as environment:
        outs = [Out(mechanism_name(name)) for name in asked.name.split(",")] if asked.name else [_small(Path(folder))]
        for out in outs:
            if not out.view.is_file():
                raise UserError(f"{out.name} has no page; make view-{out.name.replace('_', '-')} makes it")
            for name in browsers:
                place = Path(folder) / f"{name}-{out.name}"
                place.mkdir()
                for fault in _faults(name, programs[name], out, place, pictures / f"{out.name}-{name}", environment):
                    faults += 1
                    warn("browsers", f"{out.name}: {name}: {fault}")
    return int(faults > 0)


def _faults(
    name: str, program: str, out: Out, place: Path, pictures: Path, environment: dict[str, str]
) -> Iterator[str]:
    kind = BROWSERS[name][0]
    page = listening(out.view, place / "view.html")
    pictures.mkdir(parents=True, exist_ok=True)
    count = 0
    for flat in (False, True):
        browser = kind(program, place / f"profile-{flat}", environment, webgl=not flat)
        try:
            for fault in use_flat(browser, page, pictures) if flat else use(browser, out, page, pictures):
                count += 1
                yield f"{browser.version}: {fault}"
        except UserError as error:
            count += 1
            yield f"{browser.version}: {error}"
        finally:
            browser.close()
    if not count:
        say("browsers", f"{out.name}: {name} {browser.version}: all is well")


def _small(folder: Path) -> Out:
    """The four-bar of the tests, its page written."""
    from render import view
    from shared.contract.shot import Shot
    from tools.fixtures import film_fixture

    os.environ["MBSD_OUT"] = str(folder / "out")
    out = film_fixture.write(Shot(trails=()))
    view.run(out.name)
    return out


def _program(name: str) -> str:
    path = missing.program(name)
    if path is None:
        raise UserError(f"{name} is not installed; {missing.remedy([name])}")
    return path


if __name__ == "__main__":
    run_cli(main)
