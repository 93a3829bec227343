"""shot.py becomes shot.json: what the film shows, as data."""

from __future__ import annotations

from mechanisms.loading import load
from shared.console import say
from shared.errors import UserError
from shared.paths import MECHANISMS, ROOT, Out
from shared.shot import Shot, write_shot
from shared.stages import Stage, key_of


def run(name: str) -> None:
    """Check ``shot`` of a mechanism's shot.py and write out/<mechanism>/shot.json.

    Names in the shot are compared with motion and parts by the picture stages, which have both.
    Raises UserError if shot.py cannot be imported, or if a field has a wrong type or range.
    """
    out = Out(name)
    key = key_of(MECHANISMS / out.name / "shot.py", ROOT / "shared" / "shot.py")
    stage = Stage(out, "shot", key, [out.shot])
    if stage.is_fresh():
        say("shot", f"{out.name}: nothing to do")
        return
    shot = load(out.name, "shot").shot
    if not isinstance(shot, Shot):
        raise UserError(
            f"{out.name}: mechanisms/{out.name}/shot.py: 'shot' is a {type(shot).__name__}; write shot = Shot(...)"
        )
    write_shot(out.shot, shot)
    stage.done()
    say("shot", f"{out.name}: {shot.frames} frames of film, {shot.turns} turns at {shot.fps} frames a second")
