"""``python -m studio.night run|start|status|stop``: make all, make overnight, make status, make stop."""

from __future__ import annotations

import argparse

from shared.stage.console import run_cli
from studio.night.plan.options import Options, options


def main() -> int | None:
    """Read the command line and run its command."""
    parser = argparse.ArgumentParser(prog="python -m studio.night", description="Every film, whatever happens.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command, text in (("run", "make everything, here"), ("start", "make everything, in the background")):
        sub = commands.add_parser(command, help=text)
        sub.add_argument("--preset", default="preview")
        sub.add_argument("--aspect", default="", help="of the pictures: 16:9, 1:1, 4:5 or 9:16; 16:9 if not given")
        sub.add_argument("--only", default="", help="mechanisms and variants, commas between them; all if not given")
        sub.add_argument("--show", default="", help="what films show, in place of what their shots say")
        sub.add_argument("--sound", default="", help="of films: on or off; on if not given")
        sub.add_argument("--spectra", default="", help="spectra to plot of every mechanism that has them")
        sub.add_argument("--watts", default="", help="power of the machine while it renders (W), to tell the energy")
        sub.add_argument("--anyway", default="", help="1: begin though the disk is surely too small")
        sub.add_argument("--python", default="", help="the interpreter that runs the stages; this one if not given")
    fresh = commands.add_parser("fresh", help="which steps of mechanisms have nothing to do, a line of JSON each")
    fresh.add_argument("--preset", default="preview")
    fresh.add_argument("--show", default="")
    fresh.add_argument("--sound", default="")
    fresh.add_argument("--spectra", default="")
    fresh.add_argument("names", nargs="*")
    commands.add_parser("status", help="what every film is at")
    commands.add_parser("stop", help="end the runs after the current frame")
    arguments = parser.parse_args()
    if arguments.command == "fresh":
        from render.presets import preset_named
        from studio.night.plan import freshness

        preset = preset_named(arguments.preset)
        return freshness.tell(arguments.names, preset, arguments.show, arguments.spectra, arguments.sound)
    if arguments.command == "status":
        from studio.night import status

        return status.tell()
    if arguments.command == "stop":
        from studio.night import status

        return status.stop()
    return _work(arguments.command, _options(arguments))


def _work(command: str, asked: Options) -> int:
    if command == "run":
        from studio.night import night

        return night.run(asked)
    from studio.night import background

    return background.start(asked)


def _options(arguments: argparse.Namespace) -> Options:
    return options(
        arguments.only,
        arguments.preset,
        arguments.show,
        arguments.spectra,
        arguments.watts,
        arguments.python,
        arguments.anyway,
        arguments.aspect,
        arguments.sound,
    )


if __name__ == "__main__":
    run_cli(main)
