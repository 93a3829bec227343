"""The machine that comes apart and together, as a GLB of its pieces with the clip "exploded".

The motion has its own file: viewers play the first clip of a file, and some all of them at once.
"""

from __future__ import annotations

import msgspec
import numpy as np

from render.film.film import Film
from render.film.inputs import read_film
from render.film.pieces import exploded
from render.film.story.ramps import lifted
from render.glb import glb_key
from render.glb.build import mesh_of, turn
from render.glb.document import CLEARCOAT, Document, Paints
from shared.stage.console import say
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage

TOGETHER, LIFTS, APART = 0.5, 1.7, 2.4
"""Seconds: together at both ends, coming apart (and together), apart."""
RATE = 30
"""Times a second."""


def run(name: str) -> None:
    """Write out/<name>/exploded.glb, if parts, motion or shot have changed. Raises UserError."""
    out = Out(name)
    target = out.folder / "exploded.glb"
    stage = Stage(out, "exploded-glb", glb_key(out), [target])
    if stage.is_fresh():
        say("exploded", f"{out.name}: {target.name}: nothing to do")
        return
    film = read_film(out)
    whole = msgspec.structs.replace(film.shot, section=0.0)  # as the picture beside it
    write_bytes(target, exploded_glb(Film(film.motion, film.parts, whole, film.folder)))
    stage.record()
    say("exploded", f"{out.name}: {target}: {_LAST:.1f} s, {target.stat().st_size / 1e6:.1f} MB")


def exploded_glb(film: Film) -> bytes:
    """Return the file's bytes, the same each time."""
    document = Document()
    paints = Paints(document)
    lifts = exploded(film.parts, film.size)
    times = np.linspace(0.0, _LAST, round(_LAST * RATE) + 1)
    heights = np.array([lifted(lifts, _apart(float(time))) for time in times], np.float32)
    columns = {(lift.body, lift.piece): heights[:, k] for k, lift in enumerate(lifts)}
    clock = document.array(times.astype(np.float32), bounds=True)
    bodies: dict[str, int] = {}
    samplers, channels = [], []
    for piece in film.scene.pieces:
        if piece.body not in bodies:
            bodies[piece.body] = _body(document, film, piece.body)
        place = [*(piece.turns_about or (0.0, 0.0)), 0.0]
        name = f"{piece.body}/{piece.name}"
        node = document.add(
            "nodes", {"name": name, "mesh": mesh_of(document, piece, paints, film.studio.radius), "translation": place}
        )
        document.json["nodes"][bodies[piece.body]]["children"].append(node)
        height = columns[piece.body, piece.name]
        if height.any():
            ways = np.array(place, np.float32) + np.stack([0 * height, 0 * height, height], axis=1)
            samplers.append(
                {"input": clock, "output": document.array(ways.astype(np.float32)), "interpolation": "LINEAR"}
            )
            channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": "translation"}})
    name = film.motion.mechanism
    root = {"name": name, "rotation": list(turn(film.parts.mount.up)), "children": list(bodies.values())}
    document.add("scenes", {"name": name, "nodes": [document.add("nodes", root)]})
    document.json["scene"] = 0
    document.add("animations", {"name": "exploded", "samplers": samplers, "channels": channels})
    if any("extensions" in paint for paint in document.json["materials"]):
        document.json["extensionsUsed"] = [CLEARCOAT]
    return document.content()


_LAST = 2 * (TOGETHER + LIFTS) + APART


def _apart(time: float) -> float:
    """Return how far all is apart, 0 .. 1."""
    return min(max(min(time - TOGETHER, _LAST - TOGETHER - time) / LIFTS, 0.0), 1.0)


def _body(document: Document, film: Film, name: str) -> int:
    """Return a node where the body is at the start of the motion."""
    x, y, z, w, i, j, k = film.poses.pose(name, film.clock.moment(0))
    rotation = np.array([i, j, k, w], np.float32).tolist()
    return document.add("nodes", {"name": name, "translation": [x, y, z], "rotation": rotation, "children": []})
