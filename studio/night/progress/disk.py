"""Check of the disk before a night: it must have room for the pictures."""

from __future__ import annotations

from shared.stage.errors import UserError
from shared.stage.face import said
from shared.stage.paths import out_root
from studio.night.plan.options import Options
from studio.night.progress.forecast import RESERVE, Forecast, forecast, size
from studio.night.progress.frames import Frames


def refuse_before_start(asked: Options, names: tuple[str, ...]) -> None:
    """Raise UserError if solved films of ``names`` surely need more than the disk has."""
    if asked.anyway:
        return
    films = [Frames(name, asked.preset) for name in names]
    known = [film for film in films if film.read(asked.show)]
    refuse(asked, forecast(known, len(films) - len(known), asked.preset, out_root()))


def refuse(asked: Options, forecast: Forecast) -> None:
    """Raise UserError with the numbers if the forecast surely exceeds the free space.

    ANYWAY skips the check.
    """
    if asked.anyway or forecast.can_fit or forecast.free is None:
        return
    raise UserError(
        f"{forecast.pictures} pictures of {asked.preset.name} are still to be made and need {size(forecast.least)} of "
        f"disk at the least; {out_root()} has {size(forecast.free)} free, of which {size(RESERVE)} stay free. "
        "Free some space, take a smaller preset, or set MBSD_OUT to another disk; "
        f"{said(anyway='')} begins all the same and makes films as long as there is room"
    )
