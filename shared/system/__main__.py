"""``python -m shared.system``: report missing libraries, and programs with ``--for-tests``."""

from __future__ import annotations

import sys

from shared.system.missing import missing_libraries, missing_programs, packages, sentence


def main() -> int:
    """Print one line on stderr and return 1 if something is missing.

    With ``--packages`` print names of packages on stdout.
    """
    libraries = missing_libraries()
    programs = missing_programs() if "--for-tests" in sys.argv else []
    if not libraries and not programs:
        return 0
    if "--packages" in sys.argv:
        print(" ".join(packages([*libraries, *programs])))
    else:
        print(sentence(libraries, programs), file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
