"""The author's side of the line: ``python -m mechanisms {STAGE,variants,new} NAME`` and ``list``."""

from __future__ import annotations

import argparse
import importlib

from shared.stage.console import run_cli
from shared.stage.errors import UserError
from shared.stage.paths import compared, imports_space, known_name, mechanism_file, owner_of, variants_in

STAGES = {
    "parts": ("mechanisms.stages.parts.stage", "make the solids: STL, STEP and parts.json"),
    "solve": ("mechanisms.stages.solve.stage", "solve the motion: data.json"),
    "animate": ("mechanisms.stages.animate", "the moving skeleton with its arrows: animation.mp4, animation.gif"),
    "clearance": ("mechanisms.stages.clearance.stage", "prove that no two parts touch over the motion: clearance.json"),
    "print": ("mechanisms.stages.print.stage", "lay out what is to be printed, cut and bought: 3MF, STL, DXF, lists"),
    "shot": ("mechanisms.stages.shot", "check the scene's description: shot.json"),
    "tolerances": ("mechanisms.stages.tolerances", "how parts as they are made stray: tolerances/"),
}

PLANAR = {
    "animate": "animation",
    "print": "print",
    "tolerances": "analysis of tolerances",
    "export": "export",
    "study": "study",
    "check": "check",
}
"""Commands that know mechanisms in the plane alone, and what they give."""


def main() -> int | None:
    """Read the command line and run one stage; each is imported only when it is asked for."""
    arguments = _parser().parse_args()
    if arguments.command in PLANAR:
        _refuse_space(arguments.command, arguments.name)
    if arguments.command in STAGES:
        name, stage = known_name(arguments.name), importlib.import_module(STAGES[arguments.command][0])
        if arguments.command == "animate":
            return stage.run(name, view=arguments.view)
        if arguments.command == "print":
            return stage.run(name, bed=arguments.bed, gap=arguments.gap, scale=arguments.scale)
        if getattr(arguments, "if_needed", None):
            return stage.run_if_needed(name, arguments.if_needed)
        if getattr(arguments, "or_none", False):
            return stage.run_or_none(name)
        if getattr(arguments, "or_warn", False):
            return stage.run_or_warn(name)
        if arguments.command == "parts":
            return stage.run(name, scale=arguments.scale, anyway=arguments.anyway not in ("", "0"))
        if arguments.command == "solve":
            from mechanisms.stages.parts.stage import are_outdated

            return stage.run(name, are_outdated(name))
        return stage.run(name, scale=arguments.scale) if arguments.command == "clearance" else stage.run(name)
    if arguments.command == "variants":
        owner = owner_of(arguments.name)
        if not variants_in(mechanism_file(owner)):
            from mechanisms.stages.loading import loading

            loading.load(owner, "mechanism")  # where it cannot be read, that is reported
        print(owner, *(f"{owner}-{variant}" for variant in compared(owner)), sep="\n")
        return None
    if arguments.command == "export":
        from mechanisms.stages.export import stage as export

        return export.run(arguments.name, arguments.format, arguments.time)
    if arguments.command == "study":
        from mechanisms.stages import study as study

        return study.run(arguments.name, arguments.over)
    if arguments.command == "check":
        from mechanisms.stages import checking

        return checking.run(arguments.name, arguments.json)
    if arguments.command == "new":
        from mechanisms.stages.new import new

        return new.run(arguments.name, arguments.kind, arguments.single)
    from mechanisms.stages import listing

    if arguments.command == "current":
        return listing.tell_current(arguments.names)
    return listing.run(arguments.names, arguments.json)


def _refuse_space(command: str, name: str) -> None:
    """Raise UserError for a mechanism in space."""
    file = mechanism_file(owner_of(name))
    if file.is_file() and imports_space(file):
        raise UserError(
            f"{name} is a mechanism in space, for which there is no {PLANAR[command]} yet; see docs/space.md"
        )


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m mechanisms", description="Mechanisms: from a folder to files.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command, (_, text) in STAGES.items():
        sub = commands.add_parser(command, help=text)
        sub.add_argument("name", help="mechanism; four-bar and four_bar are one")
        if command == "animate":
            sub.add_argument("--view", default="", help="such as reactions,velocities; all: all side by side")
        if command == "print":
            sub.add_argument("--bed", default="", help="size of a plate in mm, 220x220 if not given")
            sub.add_argument("--gap", default="", help="distance between pieces in mm, 5 if not given")
        if command in ("parts", "print", "clearance"):
            sub.add_argument("--scale", default="", help="of a model, such as 1:20; the machine itself if not given")
        if command == "parts":
            sub.add_argument("--anyway", default="", help="1: also where the same was refused before")
            sub.add_argument("--or-none", action="store_true", help="go on where there are no automatic parts")
            sub.add_argument("--if-needed", choices=("motion", "model", "proof"), help="only if this needs them")
        if command == "clearance":
            sub.add_argument("--or-warn", action="store_true", help="go on where parts are shown and cannot be built")
    fresh = commands.add_parser("new", help="a new mechanism that already runs")
    fresh.add_argument("name", help="folder to make")
    fresh.add_argument("--kind", default="driven", help="driven or simulated")
    fresh.add_argument("--single", action="store_true", help="one file in place of a folder; for a folder of one's own")
    of = commands.add_parser(
        "variants", help="the names of a mechanism and its variants, a line each; it must have some"
    )
    of.add_argument("name", help="mechanism")
    away = commands.add_parser("export", help="the mechanism and its motion in the file of another program")
    away.add_argument("name", help="mechanism; four-bar and four_bar are one")
    away.add_argument(
        "--format", default="csv", help="of the file; csv if not given, and one that is unknown is answered by all"
    )
    away.add_argument(
        "--time", type=float, default=0.0, help="of the pose in a drawing or assembly (s); 0 if not given"
    )
    grid = commands.add_parser("study", help="the mechanism at every point of a grid of its Params: study.csv")
    grid.add_argument("name", help="mechanism; four-bar and four_bar are one")
    grid.add_argument("--over", default="", help="fields to vary: crank=0.03:0.05:5; speed=6,12")
    looked = commands.add_parser("check", help="look for likely mistakes in a model")
    looked.add_argument("name", help="mechanism; four-bar and four_bar are one")
    looked.add_argument("--json", action="store_true", help="for other programs")
    now = commands.add_parser("current", help="names of mechanisms whose motion, parts and shot are up to date")
    now.add_argument("names", nargs="*", help="mechanisms")
    every = commands.add_parser("list", help="list the mechanisms and their products")
    every.add_argument("--names", action="store_true", help="names alone, a line each")
    every.add_argument("--json", action="store_true", help="for other programs")
    return parser


if __name__ == "__main__":
    run_cli(main)
