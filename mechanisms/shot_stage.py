"""shot.py becomes shot.json: what the film shows, as data."""

from __future__ import annotations

import msgspec

from mechanisms.loading import load
from shared.console import say
from shared.errors import UserError
from shared.paths import MECHANISMS, ROOT, Out
from shared.shot import Names, Shot, refuse_unknown, write_shot
from shared.stages import Stage, key_of


def run(name: str) -> None:
    """Check ``shot`` of a mechanism's shot.py and write out/<mechanism>/shot.json.

    Names in the shot are compared with motion and parts where these are made already, as the Makefile does; the
    picture stages compare them again. Raises UserError if shot.py cannot be imported, if a field has a wrong type or
    range, or if a name is unknown.
    """
    out = Out(name)
    names = _names(out)
    key = key_of(MECHANISMS / out.name / "shot.py", ROOT / "shared" / "shot.py", names and names.listed())
    stage = Stage(out, "shot", key, [out.shot])
    if stage.is_fresh():
        say("shot", f"{out.name}: nothing to do")
        return
    shot = load(out.name, "shot").shot
    if not isinstance(shot, Shot):
        raise UserError(
            f"{out.name}: mechanisms/{out.name}/shot.py: 'shot' is a {type(shot).__name__}; write shot = Shot(...)"
        )
    if names:
        refuse_unknown(shot, names)
    write_shot(out.shot, shot)
    stage.done()
    say("shot", f"{out.name}: {shot.frames} frames of film, {shot.turns} turns at {shot.fps} frames a second")


class _Motion(msgspec.Struct):
    """The names in data.json, without its numbers."""

    mechanism: str
    joints: dict[str, msgspec.Raw]
    points: dict[str, msgspec.Raw]


class _Body(msgspec.Struct):
    pieces: dict[str, msgspec.Raw]


class _Parts(msgspec.Struct):
    bodies: dict[str, _Body]


def _names(out: Out) -> Names | None:
    """What the shot may name; None until motion and parts are made and can be read."""
    try:
        motion = msgspec.json.decode(out.motion.read_bytes(), type=_Motion)
        parts = msgspec.json.decode(out.parts.read_bytes(), type=_Parts)
    except (OSError, msgspec.DecodeError, UnicodeDecodeError):
        return None
    pieces = {body: tuple(solids.pieces) for body, solids in parts.bodies.items()}
    return Names(motion.mechanism, tuple(motion.joints), tuple(motion.points), pieces)
