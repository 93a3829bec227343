"""Pictures: ``python -m render COMMAND NAME [--preset P] [--aspect A]``."""

from __future__ import annotations

import argparse

from render.presets import ASPECTS, PRESETS, WIDE, Preset, preset_named, show_words
from shared.stage.console import run_cli
from shared.stage.paths import mechanism_name

COMMANDS = {
    "plots": "plots of the motion, its forces and its energy",
    "compare": "all variants of a mechanism on the same pages",
    "report": "what the run found, in sentences and tables: report.md",
    "glb": "the parts with their motion as one animation, for any glTF viewer",
    "usd": "the same as a USD stage, .usdc or .usdz",
    "view": "one HTML page with the machine, its forces and its plots",
    "article": "one HTML page that explains the machine in eight steps",
    "still": "one frame as a picture",
    "contact": "a sheet of twelve frames as contact.png",
    "poster": "the shot's best moment as poster.png",
    "exploded": "the parts taken apart, with names and masses, as exploded.png and .glb",
    "frames": "render every frame that is not there yet",
    "film": "frames, then the MP4",
    "scene": "save the scene as a .blend that plays the motion",
    "scene-ui": "save the scene and open it in an installed Blender",
}

WITHOUT_PRESET = ("plots", "compare", "report", "glb", "usd", "view", "article")
"""Commands that take no preset."""


def main() -> int | None:
    """Read the command line and run one stage; each is imported only when it is asked for."""
    arguments = _parser().parse_args()
    if arguments.command == "overview":
        from render.report import facts

        return facts.run()
    if arguments.command == "gallery":
        from render import gallery

        return gallery.run()
    if arguments.command == "showreel":
        from render.showreel import showreel

        preset, show = preset_named(arguments.preset, arguments.aspect), show_words(arguments.show)
        showreel.run(preset, arguments.only, show, arguments.story)
        return None
    name, command = mechanism_name(arguments.name), arguments.command.replace("_", "-")
    if command == "plots":
        from render import plots

        return plots.run(name, arguments.spectra, arguments.every)
    if command == "compare":
        from render.plots import compare

        return compare.run(name, arguments.spectra, arguments.every)
    if command == "report":
        from render import report

        return report.run(name)
    if command == "glb":
        from render import glb

        return glb.run(name)
    if command == "usd":
        from render import usd

        return usd.run(name, arguments.format)
    if command == "view":
        from render import view

        return view.run(name)
    if command == "article":
        from render import article

        return article.run(name)
    return _picture(command, name, preset_named(arguments.preset, arguments.aspect), arguments)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m render", description="From data.json, parts and shot to pictures.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command, text in COMMANDS.items():
        sub = commands.add_parser(command, aliases=[command.replace("-", "_")] if "-" in command else [], help=text)
        sub.add_argument("name", help="mechanism; four-bar and four_bar are one")
        if command not in WITHOUT_PRESET:
            sub.add_argument("--preset", default="preview", help=f"{', '.join(PRESETS)}; preview if not given")
            sub.add_argument("--aspect", default="", help=f"{', '.join(ASPECTS)}; {WIDE} if not given")
        if command not in (*WITHOUT_PRESET, "exploded"):
            sub.add_argument(
                "--show",
                default="",
                help="arrows and title: reactions,velocities,title; as in shot.py if not given",
            )
        if command == "film":
            sub.add_argument("--story", default="loop", help="loop, explain or compare; loop if not given")
            sub.add_argument("--loop", type=float, default=0.0, help="seconds of a film that ends as it begins")
        if command in ("plots", "compare"):
            sub.add_argument(
                "--spectra", default="", help="'shaking force', joints, ...; as mechanism.py says if not given"
            )
            sub.add_argument(
                "--every",
                action="store_true",
                help="one of every mechanism: leave out spectra of quantities that this one lacks",
            )
        if command == "usd":
            sub.add_argument("--format", default="usd", help="usd (.usdc) or usdz; usd if not given")
        if command == "film":
            sub.add_argument("--sound", default="", help="on or off; on if not given")
        if command == "still":
            sub.add_argument("--frame", type=int, default=0, help="number of the frame, from 0")
    commands.add_parser("gallery", help="docs/gallery/: every mechanism that has a poster")
    reel = commands.add_parser("showreel", help="the finished films, each under its title, as one")
    reel.add_argument("--preset", default="preview", help=f"{', '.join(PRESETS)}; preview if not given")
    reel.add_argument("--aspect", default="", help=f"of the films: {', '.join(ASPECTS)}; {WIDE} if not given")
    reel.add_argument("--only", default="", help="these films in this order: four_bar,geneva_drive; all if not given")
    reel.add_argument("--show", default="", help="quantities that the films show; as shot.py says if not given")
    reel.add_argument("--story", default="explain", help="explain: stories where they are made; loop: none")
    commands.add_parser("overview", help="a table of the runs that standard input lists")
    return parser


def _picture(command: str, name: str, preset: Preset, arguments: argparse.Namespace) -> None:
    if command == "exploded":
        from render.frames.story import apart
        from render.glb import exploded

        apart.run(name, preset)
        exploded.run(name)
        return
    show = show_words(arguments.show)
    if command == "film":
        from render.frames.story import kinds

        kinds.run(name, preset, show, arguments.story, arguments.loop, arguments.sound)
    elif command == "frames":
        from render.frames import frames

        frames.run(name, preset, show)
    elif command == "still":
        from render.frames import still

        still.still(name, preset, arguments.frame, show)
    elif command == "contact":
        from render.frames import still

        still.run(name, preset, show)
    elif command == "poster":
        from render.frames import still

        still.poster(name, preset, show)
    else:
        from render.frames import blend

        (blend.save if command == "scene" else blend.open_in_blender)(name, preset, show)


if __name__ == "__main__":
    run_cli(main)
