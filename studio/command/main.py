"""The command line of ``mbsd``: it is read here, and its command is run."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from shared.stage.errors import UserError, did_you_mean
from shared.stage.face import is_of_make
from shared.stage.files import remove_leftovers
from shared.stage.paths import Out, known_name, mechanism_names, work_in
from studio.command import commands, running
from studio.command.place import Place, is_path, place_of, place_of_file
from studio.command.running import Run
from studio.command.stages import OPTIONS
from studio.command.table import COMMANDS, Command

EPILOG = """\
in a folder with mechanism.py, with files such as excavator.py, or with a folder for each machine; results are put into
out/ beside them. mbsd.toml says once what is meant for all: preset = "production", bed = "180x180".

  mbsd new excavator           a machine that already runs: change it
  mbsd live excavator --open   a page that follows the editor
  mbsd run excavator           parts, motion, proof of clearance, plots, picture and film
  mbsd COMMAND --help          what a command takes

exit codes: 0 done, 1 it could not be done and stderr says why, 2 the command line is wrong, 130 stopped by Ctrl-C
"""
OPERANDS = {
    "machine": ("machine", "its name; excavator-heavy is its variant 'heavy'. It may be left out where there is one"),
    "new": ("name", "lower-case letters, digits and underscores"),
    "file": ("file", "file of another program, or an address of PMKS+"),
    "host": ("host", "user@machine, as ssh takes it"),
    "scheduler": ("address", "of the scheduler: tcp://name:8786"),
    "folder": ("folder", "folder to make"),
}


class Parser(argparse.ArgumentParser):
    """Parser whose errors suggest the command that was probably meant instead of listing all."""

    def error(self, message: str) -> NoReturn:
        """Print the error and exit with 2."""
        unknown = re.match(r"argument COMMAND: invalid choice: (?:'([^']*)'|\"([^\"]*)\")", message)
        if unknown:
            name = unknown[1] or unknown[2] or ""
            message = f"there is no command '{name}'; mbsd --help lists all{did_you_mean(name, COMMANDS)}"
        elif message.endswith("required: COMMAND"):
            self.print_help(sys.stderr)
            self.exit(2)
        super().error(message)


class Once(argparse.Action):
    """Action that joins the values of a repeated option, or rejects the repetition."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        """Keep the value; print an error and exit with 2 if the option has another already and takes one."""
        given = namespace.__dict__.setdefault("given", {}).setdefault(self.dest, [])
        option = OPTIONS[self.dest.replace("_", "-")]
        given.append(values)
        if not option.joint and len(set(given)) > 1:
            parser.error(f"--{option.name} takes one value, but was given {' and '.join(given)}")
        setattr(namespace, self.dest, option.joint.join(given) if option.joint else values)


def parser(make: bool = False) -> argparse.ArgumentParser:
    """Return the command line; with ``make`` the defaults are the variables that the Makefile exports."""
    top = Parser(
        "mbsd", description="Planar mechanisms: from one short file to physics, parts and film.", epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    top.add_argument(
        "-C", dest="folder", default=".", metavar="FOLDER", help="folder to work in; this one if not given"
    )
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND", title="commands")
    for command in COMMANDS.values():
        _add(commands, command, make)
    words = commands.add_parser("completion", help="a script for the shell that completes commands and names")
    words.add_argument("shell", choices=("bash", "zsh", "fish"))
    commands.add_parser("compile", help="compile the solver now, so that the first run does not wait for it")
    return top


def _add(commands: argparse._SubParsersAction[Parser], command: Command, make: bool) -> None:
    example = f"example: {command.example}" if command.example else None
    sub = commands.add_parser(command.name, help=command.help, description=command.help, epilog=example)
    if command.of:
        name, text = OPERANDS[command.of]
        sub.add_argument("operand", metavar=name, help=text, nargs="?" if command.of == "machine" else None, default="")
    for name in command.options:
        option = OPTIONS[name]
        default = os.environ.get(option.variable, "") if make else ""
        if option.flag:
            sub.add_argument(f"--{name}", action="store_const", const="1", default=default, help=option.help)
        else:
            choices = f": {', '.join(option.choices)}" if option.choices else ""
            usual = command.defaults.get(name, option.default)
            text = f"{option.help}{choices}" + (f"; {usual} if not given" if usual else "")
            sub.add_argument(f"--{name}", default=default, metavar=option.metavar, help=text, action=Once)
    if command.of == "machine" and "json" not in command.options:
        sub.add_argument("--json", action="store_true", help="what was done, for other programs; words go to stderr")
    planned = make and bool(os.environ.get("PLAN"))
    sub.add_argument(
        "--plan", action="store_true", default=planned, help="tell the stages that would run, and run none"
    )


def main(arguments: Sequence[str] | None = None, make: bool = False) -> int:
    """Run one command and return its exit code. Raises UserError."""
    whole = parser(make)
    asked, unknown = whole.parse_known_args(arguments)
    if unknown:
        whole.error(_unknown_word(asked.command, unknown[0]))
    if asked.command == "completion":
        from studio.command import completion

        print(completion.script(asked.shell))
        return 0
    if asked.command == "compile":  # with words before it: mbsd/__main__.py does it
        return Run({}).last([sys.executable, "-m", "mbsd", "compile"])
    command, folder = COMMANDS[asked.command], Path(asked.folder)
    if command.of == "machine" and is_path(asked.operand):
        place, asked.operand = place_of_file(folder, asked.operand)
    else:
        place = place_of(folder)
    if place.machines is not None:
        work_in(place.machines)
    os.environ.update(place.environment())
    said = _said(command, asked, place, make)
    run = Run(
        place.environment(),
        quiet=command.of == "machine" and "json" not in command.options and asked.json,
        planned=asked.plan,
    )
    operand = _operand(command, asked, place)
    if command.of == "machine" and not run.planned:
        remove_leftovers(Out(operand).folder)
    code = commands.do(command, operand, said, run)
    if run.quiet and not run.planned:
        print(running.summary(command, operand, run, code))
    return code


def _unknown_word(command: str, word: str) -> str:
    """Return an error message for a word of the command line that a command does not take."""
    options = [f"--{name}" for name in (*COMMANDS[command].options, "json", "plan")] if command in COMMANDS else []
    if not word.startswith("-"):
        return f"mbsd {command} does not take '{word}'; mbsd {command} --help says what it takes"
    known = f"; its options are: {', '.join(dict.fromkeys(options))}" if options else ""
    return f"mbsd {command} has no option '{word}'{known}{did_you_mean(word.partition('=')[0], options)}"


def _said(command: Command, asked: argparse.Namespace, place: Place, make: bool) -> dict[str, str]:
    """Return the value of each option: as given, else from mbsd.toml, else the default.

    Raises UserError for an invalid value.
    """
    said: dict[str, str] = {}
    for name in command.options:
        option = OPTIONS[name]
        kept = option.kept and name not in command.never_kept
        value = getattr(asked, name.replace("-", "_")) or (place.settings.word(name) if kept else "")
        value = value or command.defaults.get(name, option.default)
        if value and option.choices and value not in option.choices:
            where = "" if getattr(asked, name.replace("-", "_")) else " in mbsd.toml"
            hint = did_you_mean(value, option.choices)
            spelled = f"{option.variable}={value}" if make else f"--{name} {value}"
            raise UserError(f"{spelled}{where} is not a valid {name}; choose one of: {', '.join(option.choices)}{hint}")
        said[name] = value
    return said


def _operand(command: Command, asked: argparse.Namespace, place: Place) -> str:
    if command.of == "file":
        given = os.path.expanduser(asked.operand)
        return os.path.abspath(given) if os.path.exists(given) else asked.operand
    if command.of != "machine":
        return getattr(asked, "operand", "")
    name = asked.operand or place.inside
    if not name:
        names = mechanism_names()
        if len(names) != 1:
            there = f"there is: {', '.join(names)}" if names else "there is none here; mbsd new excavator makes one"
            raise UserError(f"mbsd {command.name}: name a mechanism; {there}")
        name = names[0]
    return known_name(name)


def run() -> int:
    """Run the program and exit with its code."""
    return main(sys.argv[1:], is_of_make())
