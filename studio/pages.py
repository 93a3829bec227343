"""Pages and their pictures, one mechanism after the other: fresh ones are kept, failures listed.

``python -m studio.pages [--only four_bar,pendulum]``; exit code 1 if a page or a picture fails.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Sequence

from render.view import pictures
from shared.stage.console import progress, run_cli, say, warn
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out, all_mechanisms, known_name, out_root
from shared.system import missing

# Pages and their pictures, one mechanism after the other: fresh ones are kept, failures listed.


STEPS = (("mechanisms", "parts", "--or-none"), ("mechanisms", "solve"), ("mechanisms", "shot"), ("render", "view"))
"""Stages that ``mbsd view <name>`` runs."""
SILENCE = 300.0
"""Seconds that all mechanisms may take to be asked whether they have anything to do."""
WIDTH = 120
"""Width of the table where no terminal has one (characters)."""


def run(names: Sequence[str]) -> int:
    """Write missing pages and pictures; 1 if anything failed. A call goes on from the last one."""
    browser = pictures.chromium()
    version = pictures.version_of(browser) if browser else ""
    current = _current(names)
    todo = [name for name in names if name not in current or (browser and not _is_pictured(name, version))]
    if len(todo) < len(names):
        say("pages", f"{len(names) - len(todo)} of {len(names)} have nothing to do")
    failed: dict[str, str] = {}
    if todo:
        with progress("pages", len(todo), "page") as shown:
            for name in todo:
                error = _write_page(name, name in current, browser, version)
                if error:
                    failed[name] = error
                    warn("pages", f"{name}: {error}")
                shown.advance(note=name)
    if browser is None:
        warn("pages", f"there are no pictures: they need Chromium ({missing.remedy(['chromium'])}); pages do not")
    if failed:
        _table(failed)
    say("pages", f"{len(names) - len(failed)} of {len(names)} are there, as view.html in folders of {out_root()}")
    return int(bool(failed))


def tell_fresh(names: Sequence[str]) -> int:
    """Print the names whose page is current; mechanism.py of each is run for its parameters."""
    from mechanisms.stages import shot as shot
    from mechanisms.stages.parts import stage as parts
    from mechanisms.stages.solve import stage as solve
    from render import view
    from shared.stage.memory import remembered

    with remembered():
        for name in names:
            try:
                if parts.are_current(name) and solve.is_fresh(name) and shot.is_fresh(name) and view.is_fresh(name):
                    print(name, flush=True)
            except (UserError, OSError):
                continue  # the stage tells why
    return 0


def _current(names: Sequence[str]) -> set[str]:
    """Return names whose page is current, from a process of its own, since mechanism.py runs there."""
    words = [sys.executable, "-m", "studio.pages", "--fresh", "--only", ",".join(names)]
    try:
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=SILENCE, check=False)
    except subprocess.TimeoutExpired:
        return set()
    return set(done.stdout.split()) & set(names)


def _is_pictured(name: str, version: str) -> bool:
    out = Out(name)
    return out.view.is_file() and pictures.stage_of(out, version).is_fresh()


def _write_page(name: str, is_current: bool, browser: str | None, version: str) -> str:
    """Write a page and its picture; return what went wrong, or ""."""
    if not is_current:
        for module, step, *more in STEPS:
            words = [sys.executable, "-m", module, step, name, *more]
            done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
            if done.returncode:
                said = (done.stderr.strip() or done.stdout.strip() or f"exit code {done.returncode}").splitlines()[-1]
                return f"{step}: {said}"
    if browser is None:
        return ""
    out = Out(name)
    try:
        stage = pictures.stage_of(out, version)
        if not stage.is_fresh():
            pictures.take_picture(out, browser)
            stage.record()
    except UserError as error:
        return f"picture: {error}"
    return ""


def _table(failed: dict[str, str]) -> None:
    from rich.box import SIMPLE
    from rich.console import Console
    from rich.table import Table

    table = Table(box=SIMPLE, style="red")
    table.add_column("mechanism", no_wrap=True)
    table.add_column("what could not be made", overflow="fold")
    for name, error in failed.items():
        table.add_row(name, error)
    Console(width=None if sys.stdout.isatty() else WIDTH).print(table)


# ``python -m studio.pages [--only four_bar,pendulum]``; exit code 1 if a page or a picture fails.


def main() -> int:
    """Read the command line and write missing pages and pictures."""
    parser = argparse.ArgumentParser(
        prog="python -m studio.pages", description="The page of every mechanism, and a picture of each by Chromium."
    )
    parser.add_argument("--only", default="", help="these mechanisms: four_bar,pendulum; all if not given")
    parser.add_argument("--fresh", action="store_true", help="print the names whose page has nothing to do")
    asked = parser.parse_args()
    names = [known_name(name) for name in asked.only.split(",")] if asked.only else all_mechanisms()
    if asked.fresh:
        return tell_fresh(names)
    return run(names)


if __name__ == "__main__":
    run_cli(main)
