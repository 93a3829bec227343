"""``python -m studio.site.designs NAME``: write out/<name>/designs.bin.

The file is empty if no number can be moved smoothly.
"""

from __future__ import annotations

import argparse

from shared.stage.console import run_cli, say
from shared.stage.files import write_bytes
from shared.stage.paths import Out, known_name
from studio.site.designs import stage_of


def main() -> int:
    """Solve the designs and write them."""
    parser = argparse.ArgumentParser(prog="python -m studio.site.designs", description=__doc__)
    parser.add_argument("name")
    name = known_name(parser.parse_args().name)
    stage = stage_of(Out(name))
    if stage.is_fresh():
        say("designs", f"{name}: nothing to do")
        return 0
    from studio.live.child.author import Author
    from studio.site.designs.table import table_of

    table = table_of(Author(name, lambda files: None))
    write_bytes(Out(name).designs, table.content if table else b"")
    stage.record()
    if table is None:
        say("designs", f"{name}: none of its numbers can be moved smoothly")
    else:
        say("designs", f"{name}: {', '.join(table.names)}: {table.designs} designs, {len(table.content) / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    run_cli(main)
