"""Programs in .venv/bin that find their Python beside them, so that a moved clone still runs.

An environment of ``uv venv --relocatable`` has such programs from the beginning; this is for those made before.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

BIN = Path(__file__).parent.parent / ".venv" / "bin"
NAMES_A_PYTHON = re.compile(
    rb"#!(?:[^\n]*/bin/python[\d.]*|/bin/sh\n'''exec' [^\n]*/bin/python[\d.]*[\"']? \"\$0\" \"\$@\"\n' ''')\n"
)
"""The first line of a program, or the first three where the path is long or has blanks in it."""
BESIDE = b"""#!/bin/sh
'''exec' "$(dirname -- "$(realpath -- "$0")")"/'python' "$0" "$@"
' '''
"""
"""Lines that uv writes."""


def main() -> int:
    """Rewrite the programs whose first line names a Python by its place."""
    for program in sorted(BIN.iterdir()):
        if program.is_symlink() or not program.is_file():
            continue
        content = program.read_bytes()
        named = NAMES_A_PYTHON.match(content)
        if named and not content.startswith(BESIDE):
            other = program.with_name(f".{program.name}")  # another file: a copy of a clone may share this one
            other.write_bytes(BESIDE + content[named.end() :])
            other.chmod(program.stat().st_mode)
            os.replace(other, program)
    return 0


if __name__ == "__main__":
    sys.exit(main())
