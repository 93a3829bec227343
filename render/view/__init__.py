"""The page: one HTML file with the machine, its forces and its plots, from files alone."""

from __future__ import annotations

from pathlib import Path

from render import FRAME_SOURCES
from render.freshness import clearance_files
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out, mechanism_folder
from shared.stage.stages import Stage, contract_sources, key_of, versions

LARGEST = 5_000_000
"""Bytes of a page."""


def run(name: str) -> None:
    """Write out/<name>/view.html, if what it shows has changed. Raises UserError."""
    stage = _stage(name)
    out = stage.out
    if stage.is_fresh():
        say("view", f"{out.name}: nothing to do")
        return
    from render.view.bundle import bundle
    from render.view.document import document, encode, sketch
    from render.view.payload import read_payload

    payload = read_payload(out)
    content = document(payload["title"], encode(payload), bundle(), sketch=sketch(payload["skeleton"]))
    if len(content) > LARGEST:
        raise UserError(
            f"{out.name}: the page would have {len(content) / 1e6:.1f} MB, more than {LARGEST / 1e6:.0f}; "
            "use fewer or coarser solids, or fewer times"
        )
    write_bytes(out.view, content)
    stage.record()
    say("view", f"{out.name}: {out.view}: {len(content) / 1e6:.1f} MB")


def is_fresh(name: str) -> bool:
    """Return True if there is nothing to do. Raises UserError where files that it needs are missing."""
    return _stage(name).is_fresh()


def _stage(name: str) -> Stage:
    from render.film.inputs import SHARED
    from render.view.bundle import sources_key

    out = Out(name)
    if not out.folder.is_dir():
        mechanism_folder(out.name)
    for path, target in ((out.motion, "solve"), (out.skeleton, "solve")):
        if not path.is_file():
            raise UserError(f"{out.name}: {path} is missing; run make {target}-{out.name.replace('_', '-')} first")
    there = [path for path in (out.parts, out.shot, *clearance_files(out)) if path.is_file()]
    rooms = [ROOT / "render" / name for name in ("film", "glb", "report", "blender/scene/tubes.py")]
    shared = contract_sources(*SHARED, "skeleton", "clearance")
    here = Path(__file__).parent
    ours = (
        sources_hash(here, *rooms, *FRAME_SOURCES, *shared, leave_out=[here / "pictures.py"]),
        sources_key(),
        versions("numpy"),
    )
    key = key_of(out.motion, out.skeleton, *there, *(path.name for path in there), *ours)
    return Stage(out, "view", key, [out.view])
