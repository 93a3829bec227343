"""docs/parts.md says for every kind what it becomes, and of those that become nothing that they do not."""

from __future__ import annotations

import re

import mechanisms.stages.automatic.kinds  # noqa: F401  (enters them)
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import CONTACT_KINDS, KINDS
from mechanisms.stages.automatic.layout import plan
from shared.stage.paths import ROOT

STOPS = {"angle_stop", "coordinate_stop"}
"""They are looked for by the joints whose way they end (layout/motion.py)."""


def _rows() -> tuple[set[str], set[str]]:
    """Names in the table's rows, and in those of what has no parts."""
    table = (ROOT / "docs" / "parts.md").read_text().split("## Automatic parts")[1].split("\n## ")[0]
    rows = [line for line in table.splitlines() if line.startswith("|")]
    without = [line for line in rows if "without parts |" in line]
    made = [line.split("|")[1] for line in rows if line not in without]
    return tuple({name for line in lines for name in re.findall(r"`(\w+)`", line)} for lines in (made, without))  # pyright: ignore[reportReturnType]


def test_every_kind_is_told_as_what_it_becomes() -> None:
    made, without = _rows()
    entered = {*plan.KINDS, *plan.DRIVER_KINDS, *plan.FORCE_KINDS, *plan.CONTACT_KINDS}
    every = {*KINDS, *FORCE_KINDS, *CONTACT_KINDS}
    assert made & every == (entered | STOPS) & every
    assert without & every == every - entered - STOPS
