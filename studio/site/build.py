"""Site of all mechanisms, built from their files: unchanged pages stay, failures are named.

All that is shown of a machine is of its files as they are now: its results of an older version are left out and named.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from render.freshness import Freshness
from render.gallery import small_poster
from render.view.pictures import picture_of
from shared.contract import is_in_space
from shared.contract.quantity import counted
from shared.stage import files
from shared.stage.console import progress, say, warn
from shared.stage.errors import Busy, UserError
from shared.stage.face import to_run
from shared.stage.files import refusal, write_bytes
from shared.stage.paths import ROOT, Out, out_root, refuse_links
from shared.stage.stages import Stage, key_of
from studio import pages as view_pages
from studio.site import pages
from studio.site.entries import Entry, entry_of, filters, neighbours, write_downloads
from studio.site.pages import machine, wall, write_machine_page

ASSETS = Path(__file__).with_name("assets")
TITLE = "Machines in motion"


def run(names: Sequence[str], folder: Path | None = None) -> int:
    """Build the site of these mechanisms in ``folder``, by default out/site; 1 if one is left out.

    Raises UserError where there is none to show, or another process makes a site there.
    """
    folder = folder or out_root() / "site"
    refuse_links(folder)
    with _alone(folder):
        return _run(names, folder)


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold the folder for one process: another site would remove these mechanisms as gone."""
    lock = folder.with_name(f".{folder.name}.lock")
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        handle = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
    except OSError as error:
        raise UserError(refusal(lock, error)) from error
    try:
        try:
            own = files.try_lock(handle)
        except OSError as error:
            raise UserError(refusal(lock, error, "lock")) from error
        if not own:
            raise Busy(f"another process writes {folder}; wait for it or stop it")
        yield
    finally:
        os.close(handle)


def _run(names: Sequence[str], folder: Path) -> int:
    view_pages.run(names)
    entries: list[Entry] = []
    freshness = Freshness(names)
    with progress("site", len(names), "machine") as shown:
        for name in names:
            try:
                entries.append(_write_mechanism(name, folder / name, freshness))
            except (UserError, OSError) as error:
                warn("site", f"{name} is left out: {error}")
            shown.advance(note=name)
    if not entries:
        raise UserError("site: no machine has a motion to show; the lines above say why")
    _write_pages(entries, folder)
    _remove_others(folder, {entry.name for entry in entries})
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6
    say("site", f"{counted(len(entries), 'machine')}, {size:.0f} MB: {(folder / 'index.html').as_uri()}")
    return int(len(entries) < len(names))


class _Shown:
    """Selection of a mechanism's current files; outdated ones are remembered, to be named."""

    def __init__(self, out: Out, freshness: Freshness) -> None:
        self._out, self._freshness = out, freshness
        self.older: dict[str, str] = {}
        """Names of files, and why they are not shown."""

    def is_of_now(self, path: Path) -> bool:
        why = self._freshness.why_older(self._out, path)
        if why:
            self.older[path.name] = why
        return not why

    def warn(self) -> None:
        if self.older:
            files = "; ".join(f"{file} ({why})" for file, why in self.older.items())
            warn(
                "site", f"{self._out.name}: left out, because it is outdated: {files}; {to_run('run', self._out.name)}"
            )


def _write_mechanism(name: str, folder: Path, freshness: Freshness) -> Entry:
    """Write all files of a mechanism but its own page, which names the others; return its entry."""
    out = Out(name)
    if not (out.motion.is_file() and out.view.is_file()):
        raise UserError("it has no page")
    if why := freshness.why_older(out, out.view):
        raise UserError(f"its page is outdated: {why}")
    shown = _Shown(out, freshness)
    entry = entry_of(name)
    folder.mkdir(parents=True, exist_ok=True)
    entry.has_sliders = write_machine_page(name, folder / "machine.html")
    film, in_space = next(filter(shown.is_of_now, pages.films_of(out)), None), is_in_space(out.motion)
    if film is None and not in_space:
        film = _skeleton(out)
    if film is not None:
        entry.loop = _once(film, folder / "loop.mp4", pages.write_loop)
    whole = next(filter(shown.is_of_now, pages.page_films(out)), None)
    if whole is not None:
        entry.film = _once(whole, folder / "film.mp4", _copied)
    poster = out.poster if out.poster.is_file() and shown.is_of_now(out.poster) else None
    if poster is None and film is None and in_space and picture_of(out).is_file():
        poster = picture_of(out)  # there is no moving skeleton of it
    entry.picture = _picture(poster, film, folder / "picture.jpg")
    entry.downloads = write_downloads(name, folder / "files", shown.is_of_now)
    if out.article.is_file() and shown.is_of_now(out.article):
        entry.article = _once(out.article, folder / "article.html", _copied)
    for file in {"loop.mp4", "film.mp4", "article.html"} - {entry.loop, entry.film, entry.article}:
        (folder / file).unlink(missing_ok=True)
    shown.warn()
    return entry


def _skeleton(out: Out) -> Path | None:
    """Return the moving skeleton, drawn if it is missing; None after a reported failure."""
    words = [sys.executable, "-m", "mechanisms", "animate", out.name, "--view", "skeleton"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        said = (done.stderr.strip() or done.stdout.strip() or f"exit code {done.returncode}").splitlines()[-1]
        warn("site", f"{out.name} has no film on the wall: {said}")
        return None
    return out.animation("skeleton", ".mp4")


def _picture(poster: Path | None, film: Path | None, target: Path) -> str:
    """Write the poster, else a picture of the film; return its name."""
    if poster is not None:
        return _once(poster, target, lambda source, path: write_bytes(path, small_poster(source)))
    if film is None:
        raise UserError("it has neither a poster nor a film, so there is no picture of it")
    return _once(film, target, pages.write_still)


def _copied(source: Path, target: Path) -> None:
    write_bytes(target, source.read_bytes())


def _once(source: Path, target: Path, write: Callable[[Path, Path], object]) -> str:
    """Write ``target`` unless it was written from the same source; return the file's name."""
    stage = Stage(Out(target.parent.name), f"site-{target.stem}", key_of(source), [target])
    if not stage.is_fresh():
        write(source, target)
        stage.record()
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
    """Remove folders of mechanisms that are gone, if the site has written them."""
    for other in folder.iterdir():
        if other.is_dir() and other.name not in names and (other / "machine.html").is_file():
            shutil.rmtree(other)
