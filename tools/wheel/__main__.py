"""``python -m tools.wheel``: mbsd as sdist and wheel; with --kernels wheels that hold kernels, too.

The wheels are built from the unpacked sdist. The same sources give the same bytes; SOURCE_DATE_EPOCH is the time that
the archives tell (1980 if it is not set). Compiled kernels are not the same bytes each time: LLVM's names count up.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from shared.stage.console import run_cli, say
from shared.stage.paths import ROOT
from tools.wheel.archives import build, build_with_kernels


def main() -> int:
    """Build, and name the files."""
    parser = argparse.ArgumentParser("tools.wheel", description=__doc__)
    parser.add_argument(
        "--kernels", nargs="*", metavar="VERSION",
        help="also wheels with compiled kernels: for this Python, or for these, such as 3.12 3.13",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, default=ROOT / "dist", help="the folder, dist if not given")
    asked = parser.parse_args()
    files = build(ROOT, asked.out)
    if asked.kernels is not None:
        files += [build_with_kernels(ROOT, asked.out, version) for version in asked.kernels or [""]]
    for file in files:
        say("wheel", f"{file}: {file.stat().st_size / 1000:.0f} kB")
    return 0


if __name__ == "__main__":
    run_cli(main)
