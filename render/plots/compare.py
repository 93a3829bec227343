"""Variants of a mechanism on the same pages: ``python -m render compare NAME``.

They are in out/<name>/compare/. Each variant has a colour, the same on every page; the numbers are those of their
data.json.
"""

from __future__ import annotations

from pathlib import Path

from render.plots import READ, spectra_asked
from shared.contract import Motion, read_motion
from shared.contract.quantity import counted
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import sources_hash, whole_file
from shared.stage.paths import Out, compared, owner_of
from shared.stage.stages import Stage, key_of, versions


def run(name: str, spectra: str = "", every: bool = False) -> None:
    """Draw what the variants of a mechanism do beside each other, if a motion or the drawing code changed.

    ``spectra`` as in :func:`render.plots.run`. Raises UserError for a mechanism without variants, where one is not
    solved yet, and for a spectrum of what none of them has, unless ``every`` mechanism is asked for the same.
    """
    owner = owner_of(name)
    out = Out(owner)
    files = {"as it is": out.motion} | {variant: Out(f"{owner}-{variant}").motion for variant in compared(owner)}
    for variant, file in files.items():
        if not file.is_file():
            raise UserError(f"{owner}: {file} of '{variant}' is missing; run {to_run('compare', owner)}")
    asked = spectra_asked(owner, spectra)
    key = key_of(
        asked,
        *files,
        *files.values(),
        sources_hash(Path(__file__).parent, *READ),
        versions("matplotlib", "numpy", "scipy"),
    )
    stage = Stage(out, "compare", key, [])
    if stage.is_fresh():
        say("compare", f"{owner}: nothing to do")
        return
    from render.plots.pages.comparison import figures, spectra_figure
    from render.plots.quantities import refuse_unknown_in_all

    motions: dict[str, Motion] = {variant: read_motion(file) for variant, file in files.items()}
    if spectra and not every:
        refuse_unknown_in_all(list(motions.values()), asked)
    drawn = figures(owner, motions)
    if (harmonics := spectra_figure(owner, motions, asked)) is not None:
        drawn["spectra"] = harmonics
    outputs = {plot: out.compare / f"{plot}.png" for plot in drawn}
    for plot, path in outputs.items():
        with whole_file(path) as temporary:
            drawn[plot].savefig(temporary, format="png", metadata={"Software": None})
    for older in set(out.compare.glob("*.png")) - set(outputs.values()):
        older.unlink()
    stage.outputs.extend(outputs.values())
    stage.record()
    say("compare", f"{owner}: {counted(len(outputs), 'plot')} of {counted(len(motions), 'variant')} in {out.compare}")
