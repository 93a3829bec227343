"""The GLB: ``python -m render glb NAME`` writes the parts with their motion for any glTF viewer."""

from __future__ import annotations

from pathlib import Path

from render.film.inputs import SHARED, read_film, refuse_missing
from shared.stage.console import say
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out
from shared.stage.stages import Stage, contract_sources, key_of, versions


def run(name: str) -> None:
    """Write out/<name>/<name>.glb, if the parts, the motion or the shot have changed. Raises UserError."""
    out = Out(name)
    stage = _stage(out)
    if stage.is_fresh():
        say("glb", f"{out.name}: nothing to do")
        return
    from render.glb.build import glb
    from render.glb.cut import said_of

    film = read_film(out)
    write_bytes(out.glb, glb(film))
    if said := said_of(film):
        say("glb", said)
    stage.record()
    seconds = film.motion.time[-1] - film.motion.time[0]
    say("glb", f"{out.name}: {out.glb}: {seconds:.4g} s, {out.glb.stat().st_size / 1e6:.1f} MB")


def is_fresh(name: str) -> bool:
    """Return True if there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _stage(Out(name)).is_fresh()


def _stage(out: Out) -> Stage:
    return Stage(out, "glb", glb_key(out), [out.glb])


def glb_key(out: Out) -> str:
    """Return the key of a GLB. Raises UserError if motion, parts or shot are missing."""
    refuse_missing(out)
    sources = [ROOT / "render" / name for name in ("presets.py", "film", "blender/scene/tubes.py")]
    shared = contract_sources(*SHARED)
    return key_of(
        out.motion, out.parts, out.shot, sources_hash(Path(__file__).parent, *sources, *shared), versions("numpy")
    )
