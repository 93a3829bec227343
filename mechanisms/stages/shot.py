"""The stage shot: the description of the film, checked: shot.json."""

from __future__ import annotations

import os
from typing import get_args

import msgspec

from mechanisms.stages.loading.inputs import Inputs, observed
from mechanisms.stages.loading.loading import has, load, recorded
from shared.contract.shot import LookName, Names, Shot, refuse_unknown, refuse_unsound, write_shot
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, Out, shown_file
from shared.stage.stages import Stage, key_of

SOURCES = [ROOT / "shared" / name for name in ("contract/shot.py", "contract/parts.py", "stage/jsonfile.py")]
LOOK = "MBSD_LOOK"
"""Environment variable of that wish, which mbsd.toml says."""


def run(name: str) -> None:
    """Check ``shot`` of a mechanism's shot.py, or take ``Shot()``, and write out/<mechanism>/shot.json.

    Names in the shot are compared with motion and parts where these are made already, as the Makefile does; the
    picture stages compare them again. Raises UserError if shot.py cannot be imported, if a field has a wrong type or
    range, or if a name is unknown.
    """
    out = Out(name)
    names = _names(out)
    if not has(out.name, "shot"):
        _without_file(out)
        return
    if _is_fresh(out, names):
        say("shot", f"{out.name}: nothing to do")
        return
    shot, inputs = recorded(out.name, lambda: load(out.name, "shot").shot, ("shot",), solver=True)
    file = shown_file(out.name, "shot")
    if not isinstance(shot, Shot):
        raise UserError(f"{out.name}: {file}: 'shot' is a {type(shot).__name__}; write shot = Shot(...)")
    refuse_unsound(shot, file)
    if names:
        refuse_unknown(shot, names)
    write_shot(out.shot, _looking(shot))
    Stage(out, "shot", _key(names, inputs), [out.shot]).record(inputs=inputs.names())
    say("shot", f"{out.name}: {shot.turns} turns at {shot.fps} frames a second")


def is_fresh(name: str) -> bool:
    """Return True if there is nothing to do."""
    out = Out(name)
    return _is_fresh(out, _names(out)) if has(out.name, "shot") else _stage_without_file(out).is_fresh()


def _is_fresh(out: Out, names: Names | None) -> bool:
    known = observed(Stage(out, "shot", "", []).notes().get("inputs"))
    return bool(known) and Stage(out, "shot", _key(names, known), [out.shot]).is_fresh()


def _stage_without_file(out: Out) -> Stage:
    return Stage(out, "shot", key_of(sources_hash(*SOURCES), "no shot.py", *_look()), [out.shot])


def _without_file(out: Out) -> None:
    """Write shot.json of ``Shot()``, unless it is there."""
    stage = _stage_without_file(out)
    if stage.is_fresh():
        say("shot", f"{out.name}: nothing to do")
        return
    write_shot(out.shot, _looking(Shot()))
    stage.record()
    say("shot", f"{out.name}: without a shot.py, {Shot().turns} turns at {Shot().fps} frames a second")


def _key(names: Names | None, inputs: Inputs) -> str:
    """Return the hash of all that shot.json follows from.

    ``inputs``: what shot.py is made of, and what it reads.
    """
    return key_of(sources_hash(*SOURCES), names and names.listed(), inputs.digest(), *_look())


def _look() -> list[str]:
    """Return the look that the user's folder wishes for machines whose shot names none, if it does."""
    wished = os.environ.get(LOOK)
    return [wished] if wished else []


def _looking(shot: Shot) -> Shot:
    if not _look() or shot.look is not None:
        return shot
    try:
        look = msgspec.convert(_look()[0], LookName)
    except msgspec.ValidationError:
        known = ", ".join(get_args(LookName))
        raise UserError(f"look = {_look()[0]!r} in mbsd.toml is no look; choose one of: {known}") from None
    return msgspec.structs.replace(shot, look=look)


class _Force(msgspec.Struct):
    effort: msgspec.Raw = msgspec.Raw(b"null")


class _Motion(msgspec.Struct):
    """The names in data.json, without its numbers."""

    mechanism: str
    joints: dict[str, msgspec.Raw]
    points: dict[str, msgspec.Raw]
    drivers: dict[str, msgspec.Raw]
    forces: dict[str, _Force] = {}
    contacts: dict[str, msgspec.Raw] = {}


class _Body(msgspec.Struct):
    pieces: dict[str, msgspec.Raw]


class _Parts(msgspec.Struct):
    bodies: dict[str, _Body]


def _names(out: Out) -> Names | None:
    """Return the names that a shot may use; None until motion and parts exist and can be read."""
    try:
        motion = msgspec.json.decode(out.motion.read_bytes(), type=_Motion)
        parts = msgspec.json.decode(out.parts.read_bytes(), type=_Parts)
    except (OSError, msgspec.DecodeError, UnicodeDecodeError):
        return None
    pieces = {body: tuple(solids.pieces) for body, solids in parts.bodies.items()}
    forces = [name for name, force in motion.forces.items() if bytes(force.effort) != b"null"]
    efforts, acting = (*motion.drivers, *forces), (*motion.drivers, *motion.forces, *motion.contacts)
    return Names(motion.mechanism, tuple(motion.joints), tuple(motion.points), pieces, efforts, acting)
