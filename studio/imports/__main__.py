"""``python -m studio.imports FILE [--as NAME]``: import a mechanism of another program."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from mechanisms.stages import checking
from mechanisms.stages.new.new import file_of, mark_folder, refuse_unfit
from shared.contract.quantity import counted
from shared.stage.console import run_cli, say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import write_bytes
from shared.stage.paths import NAME, shown_file
from studio.imports.reading import FORMATS, difference, read, try_out
from studio.imports.sketch import Sketch
from studio.imports.writing import mechanism_py


def main() -> int:
    """Read the file, try the mechanism, write it and check it.

    Returns 1 if the mechanism is written but looks odd or moves otherwise.
    """
    parser = argparse.ArgumentParser("studio.imports", description=f"Known are: {', '.join(FORMATS)}.")
    parser.add_argument("--as", dest="name", default="", help="its name here; that of the file if not given")
    parser.add_argument(
        "--single", action="store_true", help="one file in place of a folder; for a folder of one's own"
    )
    parser.add_argument("file", help="the file, or an address of PMKS+")
    asked = parser.parse_args()
    sketch = read(asked.file)
    name = asked.name.replace("-", "_").lower() or named(asked.file)
    try:
        refuse_unfit(name)
    except UserError as error:
        raise UserError(f"{error}; --as NAME gives another") from error
    file = file_of(name, asked.single)
    text = mechanism_py(sketch, name)
    problem = difference(sketch, try_out(text, name))
    write_bytes(file, text.encode())
    mark_folder()
    say("import", f"{shown_file(name)}: {contents(sketch)} from {sketch.program}; {to_run('live', name)} shows it")
    for words in sketch.left_out:
        warn("import", f"left out: {words}")
    if problem:
        warn("import", problem)
    return int(bool(problem) | bool(checking.run(name)))


def named(source: str) -> str:
    """Return a name of a mechanism after a file's name, or ``imported`` if that gives none."""
    stem = "" if "://" in source else Path(source).name.partition(".")[0]
    name = re.sub(r"[^a-z0-9]+", "_", stem.lower()).strip("_")
    name = name if not name[:1].isdigit() else f"linkage_{name}"
    return name if NAME.fullmatch(name) and len(name) < 60 else "imported"


def contents(sketch: Sketch) -> str:
    """Return the contents of a sketch in words: ``3 links, 4 joints and 1 motor``."""
    counts = (
        (len(sketch.links), "link"),
        (len(sketch.joints), "joint"),
        (len(sketch.motors) + len(sketch.pushes) + len(sketch.rams), "motor"),
    )
    first, second, third = (counted(count, word) for count, word in counts)
    return f"{first}, {second} and {third}"


if __name__ == "__main__":
    run_cli(main)
