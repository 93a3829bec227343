"""Plots of a motion: ``python -m render plots NAME`` draws out/<mechanism>/plots/ from data.json and skeleton.json."""

from __future__ import annotations

from pathlib import Path

from shared.console import say
from shared.contract import Motion, read_motion
from shared.errors import UserError
from shared.files import sources_hash, whole_file
from shared.paths import ROOT, Out
from shared.skeleton import read_skeleton
from shared.stages import Stage, key_of, versions


def run(name: str) -> None:
    """Draw every plot of one mechanism, if the motion or the drawing code changed; same motion, same bytes.

    Raises UserError if data.json is missing or does not hold together.
    """
    out = Out(name)
    motion, skeleton = read_motion(out.motion, out.name), read_skeleton(out.skeleton)
    if skeleton.provenance != motion.provenance:
        raise UserError(
            f"{out.name}: {out.skeleton} is of another motion than {out.motion.name}; "
            f"run make solve-{out.name.replace('_', '-')}"
        )
    outputs = {plot: out.plots / f"{plot}.png" for plot in plots_of(motion)}
    sources = sources_hash(
        Path(__file__).parent, *sorted((ROOT / "shared").glob("contract*.py")), ROOT / "shared" / "skeleton.py"
    )
    key = key_of(out.motion, out.skeleton, sources, versions("matplotlib", "numpy", "scipy"))
    stage = Stage(out, "plots", key, list(outputs.values()))
    if stage.is_fresh():
        say("plots", f"{out.name}: nothing to do")
        return

    from render.plots.figures import figure  # matplotlib takes a second to load

    for plot, path in outputs.items():
        with whole_file(path) as temporary:
            # No software, no date: the same motion gives the same bytes.
            figure(plot, motion, skeleton).savefig(temporary, format="png", metadata={"Software": None})
    for older in set(out.plots.glob("*.png")) - set(outputs.values()):
        older.unlink()
    stage.done()
    say("plots", f"{out.name}: {len(outputs)} plots in {out.plots}")


def plots_of(motion: Motion) -> list[str]:
    """Names of the plots that this motion has something to show in."""
    names = ["path", "bodies", "energy"]
    if motion.joints:
        names += ["reactions", "hodographs"]
    if motion.forces or motion.contacts:
        names.append("forces")
    names += [f"point-{point}" for point in motion.points]
    return names + [f"slider-{name}" for name, body in motion.bodies.items() if _only_slides(body.theta)]


def _only_slides(theta: list[float]) -> bool:
    return max(theta) - min(theta) < 1e-9
