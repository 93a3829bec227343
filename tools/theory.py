"""Writes docs/theory.md from the docstrings that open the solver's files: ``make docs``."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "theory.md"
FORCES = (
    "mbsd/model/force.py",
    "mbsd/model/forces",
    "mbsd/model/cylinders",
    "mbsd/equations/interactions/apply.py",
    "mbsd/equations/joint_friction.py",
    "mbsd/model/laws/curve.py",
    "mbsd/results/energy.py",
)
ANALYSES = (
    "mbsd/analyses/statics.py",
    "mbsd/analyses/balance.py",
    "mbsd/analyses/tangent.py",
    "mbsd/analyses/linearise.py",
    "mbsd/analyses/state_space.py",
    "mbsd/analyses/modes.py",
    "mbsd/analyses/efforts.py",
)
SECTIONS = (
    ("Coordinates", "", ("mbsd/equations/markers.py",)),
    (
        "Constraints",
        "Every joint and driver is made of these; each gives rows of Phi and J.",
        ("mbsd/equations/constraints", "mbsd/equations/relative"),
    ),
    ("Joints", "", ("mbsd/model/joints",)),
    (
        "Drivers",
        "A driver is a constraint with a law of time; its effort is minus its multiplier.",
        ("mbsd/model/drivers",),
    ),
    ("Laws of motion", "", ("mbsd/model/laws", "mbsd/model/laws/fitting")),
    ("Cams", "", ("mbsd/model/cams",)),
    (
        "Positions, velocities, accelerations",
        "",
        (
            "mbsd/kinematics/newton.py",
            "mbsd/kinematics/change_points",
            "mbsd/kinematics/elimination.py",
            "mbsd/kinematics/groups",
            "mbsd/kinematics/groups/carrying",
            "mbsd/kinematics/groups/kinds",
            "mbsd/kinematics/groups/newton/block.py",
        ),
    ),
    ("Mobility", "", ("mbsd/kinematics/pose/mobility.py",)),
    ("Inverse dynamics", "", ("mbsd/kinematics/multipliers.py", "mbsd/arrays/efforts_beside.py")),
    ("Forces", "", FORCES),
    (
        "Forward dynamics",
        "",
        (
            "mbsd/dynamics",
            "mbsd/kinematics/pose/initial.py",
            "mbsd/dynamics/prepare",
            "mbsd/dynamics/reference",
            "mbsd/dynamics/runs",
            "mbsd/dynamics/events",
            "mbsd/dynamics/events/friction",
            "mbsd/dynamics/events/sticking",
            "mbsd/dynamics/events/laws",
            "mbsd/dynamics/events/users",
            "mbsd/dynamics/repeated_rows",
            "mbsd/dynamics/genevas",
        ),
    ),
    (
        "Independent coordinates",
        "What forward dynamics does where a mechanism falls apart into driven bodies and Assur groups.",
        ("mbsd/dynamics/independent",),
    ),
    (
        "Integrators",
        "",
        (
            "mbsd/dynamics/integrators",
            "mbsd/dynamics/integrators/dop853",
            "mbsd/dynamics/integrators/radau",
            "mbsd/dynamics/integrators/others",
        ),
    ),
    ("Analyses", "", ANALYSES),
)
FEWEST_LINES = 2
"""A docstring of one line has no equations to show."""
HEAD = """# Theory

A body has three coordinates, x and y of its centre of mass and its angle theta; all of them are q, their rates v.
Joints and drivers are equations Phi(q, t) = 0 with the Jacobian J. The solver finds, in this order,

    Phi(q, t) = 0        positions
    J v = nu             velocities,     nu = -dPhi/dt
    J a = gamma          accelerations
    M a + J^T lam = Q    multipliers lam; the reaction on body b is -J_b^T lam

M is constant and diagonal, for q holds centres of mass. SI units, radians, counter-clockwise positive; `s_perp` is a
vector turned by a right angle, (-s_y, s_x). What follows is what each file of the solver says of itself; `make docs`
writes this page.
"""


def page() -> str:
    """The page as it should be."""
    parts = [HEAD]
    for title, words, places in SECTIONS:
        entries = [text for place in places for text in _entries(ROOT / place)]
        if entries:
            parts.append("\n".join([f"## {title}\n", *([words + "\n"] if words else []), *dict.fromkeys(entries)]))
    return "\n".join(parts)


def _entries(place: Path) -> list[str]:
    files = [place] if place.suffix == ".py" else sorted(place.glob("*.py")) if place.is_dir() else []
    return [entry for file in files if (entry := _entry(file))]


def _entry(file: Path) -> str:
    text = ast.get_docstring(ast.parse(file.read_text())) or ""
    first, _, rest = text.partition("\n\n")
    if len(rest.splitlines()) < FEWEST_LINES or file.name.startswith("__"):
        return ""
    source = file.relative_to(ROOT).as_posix()
    named = re.match(r"([A-Z]{2,}):", first)
    title = named[1] if named else file.stem.replace("_", " ").capitalize()
    return f"### {title}\n\n{' '.join(first.split())}\n\n```text\n{rest}\n```\n\n`{source}`\n"


def main() -> int:
    """Write the page, or with --check tell whether it is as it should be."""
    wanted = page()
    if sys.argv[1:] == ["--check"]:
        return 0 if PAGE.exists() and PAGE.read_text() == wanted else 1
    PAGE.write_text(wanted)
    return 0


if __name__ == "__main__":
    sys.exit(main())
