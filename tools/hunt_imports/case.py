"""One damaged file, imported as ``mbsd import`` does until it would write the mechanism.

agreed     read, and what would be written loads, builds and can be looked at
refused    a UserError; its reason without the numbers and names of the case
wrong      anything else that is raised, and a UserError that calls itself a fault of the importer
"""

from __future__ import annotations

import io
import re
import tempfile
import time
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

from mbsd import MechanismError
from shared.stage.errors import UserError
from studio.imports.reading import difference, read, try_out
from studio.imports.writing import mechanism_py
from tools.hunt.outcome import AGREED, REFUSED, WRONG, CaseResult, Outcome
from tools.hunt_imports.mutations import Damaged, damaged
from tools.random_mechanisms.subject import Raw, attempt

FAULT = "fault of this importer"
NAMED, NUMBER = re.compile(r"'[^']*'|\"[^\"]*\""), re.compile(r"[-+]?\d[\w.+-]*")


def run(seed: int, kind: str | None = None) -> CaseResult:
    """Return what came of a case, the same each time."""
    began = time.monotonic()
    case = damaged(seed, kind)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / case.name
        if not case.is_address:
            file.write_bytes(case.content)
        outcome = judged(case, case.content.decode("utf-8", "replace") if case.is_address else str(file))
    return CaseResult(seed, case.kind, [outcome], time.monotonic() - began)


def judged(case: Damaged, source: str) -> Outcome:
    """Return what comes of an import; what it prints is dropped."""
    try:
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            _, error = attempt(lambda: _imported(source))
    except Raw as raw:
        if isinstance(raw.__cause__, UserError):
            words = str(raw.__cause__)
            return Outcome(case.mutation, WRONG if FAULT in words else REFUSED, reason(words), words[:300])
        return Outcome(case.mutation, WRONG, "a traceback", str(raw)[:600])
    if error is not None:
        return Outcome(case.mutation, WRONG, "a MechanismError that is no UserError", str(error)[:600])
    return Outcome(case.mutation, AGREED)


def _imported(source: str) -> None:
    """Read, write and look at a file as ``mbsd import`` does, without putting anything anywhere."""
    sketch = read(source)
    m = try_out(mechanism_py(sketch, "imported"), "imported")
    difference(sketch, m)
    try:
        m.check()
    except MechanismError as error:  # which mbsd check reports
        raise UserError(f"imported: {error}") from error


def reason(words: str) -> str:
    """A refusal without the names and numbers of the case, so that equal ones are counted together."""
    text = words.partition(": ")[2] or words
    return NUMBER.sub("0", NAMED.sub("'...'", text))[:110]
