"""``make docs-site``: docs/ and what it links to as pages in out/docs, with every link checked.

python -m tools.site [--out FOLDER]
"""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path

from shared.stage.console import run_cli, say
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, out_root
from tools.site.build import build
from tools.site.checks import faults

NEEDED = {"mkdocs": "mkdocs", "material": "mkdocs-material"}


def main() -> int:
    """Build, check, and say where the first page is."""
    parser = argparse.ArgumentParser("tools.site", description=__doc__)
    parser.add_argument("--out", type=Path, default=out_root() / "docs", help="the folder, out/docs if not given")
    out = parser.parse_args().out.resolve()
    refuse_without_packages()
    say("site", "building, which takes half a minute")
    build(ROOT, out)
    if wrong := faults(out):
        raise UserError(f"site: {len(wrong)} links lead nowhere or into the network: " + "; ".join(wrong[:10]))
    say("site", f"{sum(1 for _ in out.rglob('*.html'))} pages; open {(out / 'index.html').as_uri()}")
    return 0


def refuse_without_packages() -> None:
    """Raise UserError that names missing packages of the extra ``docs``, and what brings them."""
    missing = [package for module, package in NEEDED.items() if find_spec(module) is None]
    if missing:
        raise UserError(
            f"site: needs {' and '.join(missing)}, which this Python has not; in a clone make install brings them, "
            "elsewhere pip install 'mbsd[docs]'"
        )


if __name__ == "__main__":
    run_cli(main)
