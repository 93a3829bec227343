"""What tolerances.py asks: by the name of a result, what :func:`mbsd.tolerances` is to take.

    def tolerances(p: Params) -> dict[str, dict[str, Any]]:
        sizes = {"crank": "m", "rod": "m", "A": Clearance.from_fit(0.006, "H7/g6")}
        return {"far_end": {"sizes": sizes, "result": largest("slider.x"), "limits": (0.1597, 0.1603)}}

A mechanism.py with a DURATION gives its own where nothing else is said.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from mechanisms.stages.loading import loading, variants
from mechanisms.stages.loading.author_functions import refuse_arguments
from mechanisms.stages.solve import solving
from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.paths import NAME, shown_file
from shared.stage.suggestions import did_you_mean

if TYPE_CHECKING:
    from mbsd import Mechanism, Tolerances

TAKEN = ("sizes", "result", "limits", "n", "seed", "duration", "steps", "way", "sobol", "corners", "confidence")
"""Arguments of mbsd.tolerances that a result may give."""
FORM = 'def tolerances(p): return {"far_end": {"sizes": {"crank": 5e-5}, "result": largest("slider.x")}}'


def asked(name: str, m: Mechanism, p: Any) -> dict[str, Callable[..., Tolerances]]:
    """By result, what finds it when it is called. Raises UserError for whatever cannot be, before anything is found."""
    module = loading.load(name, "tolerances")
    file = shown_file(name, "tolerances")
    refuse_arguments(file, module.tolerances, p)
    with loading.author_code(name):
        given = module.tolerances(p)
    if not isinstance(given, Mapping) or not given:
        raise UserError(f"{file}: tolerances() returned {_shown(given)}; it names results: {FORM}")
    duration = variants.constant(name, loading.load(name, "mechanism"), "DURATION")
    usual = {} if duration is None else {"duration": duration}
    for result, options in given.items():
        _refuse_unfit(file, result, options)
    return {result: _ready(name, file, result, m, usual | dict(options)) for result, options in given.items()}


def _refuse_unfit(file: str, result: Any, options: Any) -> None:
    if not isinstance(result, str) or not NAME.fullmatch(result):
        raise UserError(
            f"{file}: {result!r} is no name of a result, which is that of its files, too; write lower-case letters, "
            "digits and underscores, a letter first"
        )
    if not isinstance(options, Mapping):
        raise UserError(f"{file}: '{result}' is {_shown(options)}; it takes a dict: {FORM}")
    for word in options:
        if word not in TAKEN:
            raise UserError(
                f"{file}: '{result}' takes no {word!r}; it takes: {', '.join(TAKEN)}{did_you_mean(str(word), TAKEN)}"
            )
    for word in ("sizes", "result"):
        if word not in options:
            raise UserError(f"{file}: '{result}' says no '{word}'; {FORM}")


def _ready(name: str, file: str, result: str, m: Mechanism, options: dict[str, Any]) -> Callable[..., Tolerances]:
    from mbsd import MechanismError
    from mbsd.tolerancing.tolerances import asked as ready

    try:
        with loading.author_code(name), solving.model_warnings_said():
            return ready(copy.deepcopy(m), **options, progress=_progress(f"{name}: {result}"))
    except MechanismError as error:
        raise UserError(f"{file}: '{result}': {error}") from error


def _progress(what: str) -> Callable[[float], None]:
    """Says now and then what part of the machines is solved, where that takes long."""
    bar: list[console.Shown] = []

    def progress(part: float) -> None:
        if not bar:
            bar.append(console.Shown("tolerances", what, 100, "per cent of its machines"))
        bar[0].count = max(1, int(100 * part)) - 1
        bar[0].advance()

    return progress


def _shown(given: Any) -> str:
    from mbsd.base.names import shown

    return shown(given)
