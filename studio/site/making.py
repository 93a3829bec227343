"""The site of all machines, made from their files: what has not changed is left, and a machine that fails is named."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from render.gallery.posters import small_poster
from shared.stage import locks
from shared.stage.console import progress, say, warn
from shared.stage.errors import Busy, UserError
from shared.stage.files import refusal, write_bytes
from shared.stage.paths import ROOT, Out, in_workshop, out_root, refuse_links
from shared.stage.stages import Stage, key_of
from studio.pages import making as view_pages
from studio.site import loops
from studio.site.downloads import write_downloads
from studio.site.entries import Entry, entry_of
from studio.site.machine_page import write_machine_page
from studio.site.pages import machine, wall
from studio.site.purposes import filters, neighbours

ASSETS = Path(__file__).with_name("assets")
TITLE = "Machines in motion"


def run(names: Sequence[str], folder: Path | None = None) -> int:
    """Make the site of these machines in ``folder``, out/site if not given; 1 if one of them is left out.

    Raises UserError where there is none to show, or another process makes a site there.
    """
    folder = folder or out_root() / "site"
    refuse_links(folder)
    with _alone(folder):
        return _run(names, folder)


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold the folder for one process: the machines of another site would be removed as gone."""
    lock = folder.with_name(f".{folder.name}.lock")
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        handle = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
    except OSError as error:
        raise UserError(refusal(lock, error)) from error
    try:
        try:
            own = locks.take(handle)
        except OSError as error:
            raise UserError(refusal(lock, error, "lock")) from error
        if not own:
            raise Busy(f"another process makes {folder}; wait for it or stop it")
        yield
    finally:
        os.close(handle)


def _run(names: Sequence[str], folder: Path) -> int:
    view_pages.run(names)
    entries: list[Entry] = []
    with progress("site", len(names), "machine") as shown:
        for name in names:
            try:
                entries.append(_made(name, folder / name))
            except (UserError, OSError) as error:
                warn("site", f"{name} is left out: {error}")
            shown.advance(note=name)
    if not entries:
        raise UserError("site: no machine has a motion to show; the lines above say why")
    _write_pages(entries, folder)
    _remove_others(folder, {entry.name for entry in entries})
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6
    machines = f"{len(entries)} machine{'' if len(entries) == 1 else 's'}"
    say("site", f"{machines}, {size:.0f} MB: {(folder / 'index.html').as_uri()}")
    return int(len(entries) < len(names))


def _made(name: str, folder: Path) -> Entry:
    """Everything of a machine but its own page, which names the others."""
    out = Out(name)
    if not (out.motion.is_file() and out.view.is_file()):
        raise UserError("it has no page")
    entry = entry_of(name)
    folder.mkdir(parents=True, exist_ok=True)
    entry.has_sliders = write_machine_page(name, folder / "machine.html")
    film = loops.film_of(out) or _skeleton(name)
    if film is not None:
        entry.loop = _once(film, folder / "loop.mp4", loops.write_loop)
    whole = loops.page_film(out)
    if whole is not None:
        entry.film = _once(whole, folder / "film.mp4", _copied)
    entry.picture = _picture(name, film, folder / "picture.jpg")
    entry.downloads = write_downloads(name, folder / "files")
    return entry


def _skeleton(name: str) -> Path | None:
    """The skeleton in motion, made where there is no film; None where it cannot be drawn, which is reported."""
    words = [sys.executable, "-m", "mechanisms", "animate", name, "--view", "skeleton"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        said = (done.stderr.strip() or done.stdout.strip() or f"exit code {done.returncode}").splitlines()[-1]
        warn("site", f"{name} stands still on the wall: {said}")
    return loops.film_of(Out(name))


def _picture(name: str, film: Path | None, target: Path) -> str:
    """The poster, else the one of the gallery, else a picture of the film."""
    out, shipped = Out(name), ROOT / "docs" / "gallery" / f"{name}.jpg"
    if out.poster.is_file():
        return _once(out.poster, target, lambda source, path: write_bytes(path, small_poster(source)))
    if shipped.is_file() and not in_workshop():
        return _once(shipped, target, _copied)
    if film is None:
        raise UserError("it has neither a poster nor a film, so there is no picture of it")
    return _once(film, target, loops.write_still)


def _copied(source: Path, target: Path) -> None:
    write_bytes(target, source.read_bytes())


def _once(source: Path, target: Path, write: Callable[[Path, Path], object]) -> str:
    """Write ``target`` unless it was made from the source as it is; the name of the file."""
    stage = Stage(Out(target.parent.name), f"site-{target.stem}", key_of(source), [target])
    if not stage.is_fresh():
        write(source, target)
        stage.done()
    return target.name


def _write_pages(entries: list[Entry], folder: Path) -> None:
    purposes_of = {entry.name: entry.purposes for entry in entries}
    by_name = {entry.name: entry for entry in entries}
    for entry in entries:
        others = [by_name[other] for other in neighbours(entry.name, purposes_of)]
        _write(folder / entry.name / "index.html", machine(entry, others).encode())
    _write(folder / "index.html", wall(TITLE, entries, filters(purposes_of)).encode())
    for asset in sorted(ASSETS.glob("*.*")):
        _write(folder / asset.name, asset.read_bytes())


def _write(path: Path, content: bytes) -> None:
    if not path.is_file() or path.read_bytes() != content:
        write_bytes(path, content)


def _remove_others(folder: Path, names: set[str]) -> None:
    """Folders of machines that are gone; only such as the site has made."""
    for other in folder.iterdir():
        if other.is_dir() and other.name not in names and (other / "machine.html").is_file():
            shutil.rmtree(other)
