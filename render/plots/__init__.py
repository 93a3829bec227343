"""Plots of a motion: ``python -m render plots NAME`` draws out/<mechanism>/plots/.

They show data.json and skeleton.json.
"""

from __future__ import annotations

import ast
from pathlib import Path

from render import FRAME_SOURCES
from shared.contract import Motion, Motion3, read_any_motion
from shared.contract.quantity import counted
from shared.contract.skeleton import read_skeleton
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import sources_hash, whole_file
from shared.stage.paths import ROOT, Out, mechanism_file, shown_file, variant_of
from shared.stage.stages import Stage, contract_sources, key_of, versions

READ = [
    *contract_sources("skeleton"),
    *FRAME_SOURCES,
    *(ROOT / "render" / "report" / f"{name}.py" for name in ("transmission", "written")),
]


def run(name: str, spectra: str = "", every: bool = False) -> None:
    """Draw every plot of a mechanism if the motion or the drawing code changed.

    The same motion gives the same bytes. ``spectra``: names of quantities, commas between them, instead of those of
    mechanism.py. Raises UserError if data.json is missing or does not hold together, and for a spectrum of what there
    is not, unless ``every`` mechanism is asked for the same.
    """
    out = Out(name)
    motion, skeleton = read_any_motion(out.motion, out.name), read_skeleton(out.skeleton)
    if skeleton.provenance != motion.provenance:
        raise UserError(
            f"{out.name}: {out.skeleton} is of another motion than {out.motion.name}; run {to_run('solve', out.name)}"
        )
    if isinstance(motion, Motion3):
        from render.plots.pages.space import plots_in_space

        names = plots_in_space(motion)
    else:
        names = [*plots_of(motion), *_spectra(motion, out.name, spectra, every)]
    outputs = {plot: out.plots / f"{plot}.png" for plot in names}
    stage = _stage(out, names)
    if stage.is_fresh():
        if not is_fresh(name, spectra, every):  # asked for in other words
            stage.record(plots=names, asked=[*spectra_asked(out.name, spectra), every])
        say("plots", f"{out.name}: nothing to do")
        return

    from render.plots.figures import figure  # matplotlib takes a second to load

    for plot, path in outputs.items():
        with whole_file(path) as temporary:
            # No software, no date: the same motion gives the same bytes.
            figure(plot, motion, skeleton).savefig(temporary, format="png", metadata={"Software": None})
    for older in set(out.plots.glob("*.png")) - set(outputs.values()):
        older.unlink()
    stage.record(plots=names, asked=[*spectra_asked(out.name, spectra), every])
    say("plots", f"{out.name}: {counted(len(outputs), 'plot')} in {out.plots}")


def is_fresh(name: str, spectra: str = "", every: bool = False) -> bool:
    """Return True if the plots of the last drawing are those of this motion.

    The same motion has the same plots.

    Raises UserError for a SPECTRA in mechanism.py that is none, OSError where the motion is missing.
    """
    out = Out(name)
    notes = Stage(out, "plots", "", []).notes()
    known = notes.get("plots")
    if not isinstance(known, list) or notes.get("asked") != [*spectra_asked(out.name, spectra), every]:
        return False
    return _stage(out, known).is_fresh()


def _stage(out: Out, names: list[str]) -> Stage:
    sources = sources_hash(Path(__file__).parent, *READ)
    key = key_of(out.motion, out.skeleton, sources, names, versions("matplotlib", "numpy", "scipy"))
    return Stage(out, "plots", key, [out.plots / f"{plot}.png" for plot in names])


def plots_of(motion: Motion) -> list[str]:
    """Return names of the plots that this motion has something to show in."""
    names = ["path", "bodies", "energy"]
    if motion.joints:
        names += ["reactions", "hodographs"]
    if motion.forces or motion.contacts:
        names.append("forces")
    if motion.couple is not None and motion.vibration is not None:
        names.append("frame")
    if any(force.gas is not None for force in motion.forces.values()):
        names.append("gas")
    if any(force.hydraulics is not None for force in motion.forces.values()):
        names.append("hydraulics")
    if motion.analysis == "simulation":
        from render.magnitudes import crank_of

        names += ["turns"] * (crank_of(motion) is not None)
    names += [f"point-{point}" for point in motion.points]
    return names + [f"slider-{name}" for name, body in motion.bodies.items() if _only_slides(body.theta)]


def _spectra(motion: Motion, name: str, words: str, every: bool) -> list[str]:
    """Return plots of the spectra that are asked for; a variant may lack what mechanism.py names."""
    asked = spectra_asked(name, words)
    if not asked:
        return []
    from render.plots.quantities import known_names, refuse_unknown

    if not (every and words) and (words or variant_of(name) is None):
        refuse_unknown(motion, asked)
    known = known_names(motion)
    return [f"spectrum-{page.replace(' ', '-')}" for page in asked if page in known]


def _only_slides(theta: list[float]) -> bool:
    return max(theta) - min(theta) < 1e-9


# Reads which spectra are wanted: ``SPECTRA = ("shaking force", "motor")`` in mechanism.py, or SPECTRA=... of make.

FORM = 'write names in quotes: SPECTRA = ("shaking force", "motor")'


def spectra_asked(name: str, words: str = "") -> list[str]:
    """Return names of quantities, each once: from ``words``, else from mechanism.py.

    ``words`` have commas between them. The file is read without running it. Raises UserError where its SPECTRA is no
    plain tuple or list of texts.
    """
    if words.strip():
        return list(dict.fromkeys(word.strip() for word in words.split(",") if word.strip()))
    file = mechanism_file(name)
    try:
        tree = ast.parse(file.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return []
    for statement in tree.body:
        targets = getattr(statement, "targets", [getattr(statement, "target", None)])
        if any(isinstance(target, ast.Name) and target.id == "SPECTRA" for target in targets):
            return _names(statement, f"{shown_file(name)}:{statement.lineno}")
    return []


def _names(statement: ast.stmt, where: str) -> list[str]:
    value = getattr(statement, "value", None)
    given = None
    if value is not None:
        try:
            given = ast.literal_eval(value)
        except ValueError:
            given = None
    if not isinstance(given, tuple | list) or not all(isinstance(name, str) for name in given):
        raise UserError(f"{where}: SPECTRA is not a list of names that can be read without running the file; {FORM}")
    return list(dict.fromkeys(given))
