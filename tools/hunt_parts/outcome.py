"""Outcome of the parts of one mechanism."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path

from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT
from tools.hunt.outcome import BASE, CaseResult, Outcome

BUILT, REFUSED, STUCK = "built", "refused", "no motion"
COLLIDES, UNSOUND, ERROR, HUNG = "collides", "unsound", "error", "hung"
"""no motion: the mechanism itself cannot follow. unsound: a solid that is open, in pieces, or overlaps another one of
its body. error: what a user would see as a traceback."""
STATES = (BUILT, REFUSED, STUCK, COLLIDES, UNSOUND, ERROR, HUNG)
WRONG = (COLLIDES, UNSOUND, ERROR, HUNG)

_NAMED = re.compile(r"'[^']*'")
_NUMBER = re.compile(r"[-+]?\d[\d.e+-]*")
_REASONS = ("no order of layers", "has no automatic parts", "have no automatic parts", "must hang from a bridge")
_PROVEN, _GIVEN_UP = "between two samples of data.json", "was given up: their"


def reason(text: str) -> str:
    """A refusal without the names and numbers of the case, so that equal ones are counted together."""
    for words in _REASONS:
        if words in text:
            kind = re.search(r"is an? ([\w -]+?), which|a part on (ground)", text)
            return f"{words}: {next(word for word in kind.groups() if word)}" if kind else words
    if _PROVEN in text:
        return "the motion is too quick for its samples to prove it"
    if _GIVEN_UP in text:
        return "the search for the least gap was given up"
    text = text.partition(": ")[2] or text
    return _NUMBER.sub("0", _NAMED.sub("'...'", text))[:110]


# Cases that a hunt has looked at, a line each as they end: one that is killed goes on from there, on any night.


SOURCES = [
    ROOT / room for room in ("mbsd", "mechanisms/stages", "shared", "tools/hunt_parts", "tools/random_mechanisms")
]


class Kept:
    """The lines of a file; the seed decides a case, so one that is there is not looked at again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.sources = sources_hash(*SOURCES)[:12]
        """Hash of the program as it is; each line has that of its own."""
        self.others = 0
        """How many of the lines that were read are of another program."""

    def read(self, seeds: Iterable[int]) -> list[CaseResult]:
        """Results of these cases. A last line that was cut is taken off the file."""
        if not self.path.exists():
            return []
        content = self.path.read_bytes()
        whole = content[: content.rfind(b"\n") + 1]
        if whole != content:
            write_bytes(self.path, whole)
        wanted, results = set(seeds), {}
        for line in whole.splitlines():
            result = json.loads(line)
            if result["seed"] in wanted:
                results[result["seed"]] = result
        self.others = sum(result["sources"] != self.sources for result in results.values())
        return [_result(result) for result in results.values()]

    def add(self, result: CaseResult) -> None:
        """One more line."""
        last = result.outcomes[-1]
        record = {"seed": result.seed, "kind": result.family, "state": last.state, "reason": last.reason}
        record |= {"detail": last.detail, "seconds": round(result.seconds, 2), "sources": self.sources}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("ab") as file:
            file.write(json.dumps(record).encode() + b"\n")


def _result(line: dict[str, str]) -> CaseResult:
    outcome = Outcome(BASE, line["state"], line["reason"], line["detail"])
    return CaseResult(int(line["seed"]), line["kind"], [outcome], float(line["seconds"]))
