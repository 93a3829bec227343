"""Says in a sentence what the author's code raised: the file, the author's own line, the error, a remedy if known."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType

from shared.shapes.kernel import is_of_kernel

OPERATIONS = {
    "fillet": "a fillet must be smaller than half of the narrowest web beside its edges: make it smaller, round fewer "
    "edges, or round them before the cuts that narrow the web",
    "chamfer": "a chamfer must be smaller than the faces beside its edges: make it smaller, or choose fewer edges",
    "shell": "a shell must be thinner than half of the narrowest wall: make it thinner",
    "cut": "the two solids may touch along a face or an edge only: move or enlarge the tool a little",
    "union": "the two solids may touch along an edge only: let them overlap",
    "revolve": "the profile must be closed and lie on one side of its axis",
    "extrude": "the outline must be closed and must not cross itself, and the height must not be 0",
}
"""CadQuery's operations that fail for geometry, with what to change."""
SHOWN = 3
"""Arguments of the failed operation that are quoted at most."""


def worded(
    error: BaseException, lines: Sequence[traceback.FrameSummary], shown: Callable[[Path], str] = Path.as_posix
) -> str:
    """``file:line: what was raised, in function(): the author's line``; ``lines`` are the author's, innermost last.

    For the CAD kernel's exceptions, which say no more than "command not done", the operation with its arguments, the
    line of ``parts()`` that led there and the remedy are added.
    """
    last = lines[-1]
    where = f"{shown(Path(last.filename))}:{last.lineno}"
    if isinstance(error, SystemExit):
        what = f"SystemExit: the file ends the program with exit({error.code if error.code is not None else ''})"
    else:
        what = f"{type(error).__name__}: {error}".rstrip(": ")
    within = f"in {last.name}(): " if last.name.isidentifier() else ""
    text = f"{where}: {what}" + (f", {within or 'at: '}{last.line}" if last.line else "")
    caller = next((line for line in lines if line.name == "parts" and line is not last), None)
    if caller is not None and caller.line:
        text += f" (from line {caller.lineno}: {caller.line.rstrip(',')})"
    if not is_of_kernel(error):
        return text
    operation, arguments = _operation(error)
    if operation is None:
        return f"{text}. CadQuery could not make this shape: look for sizes that are zero, negative or too large"
    return f"{text}. CadQuery could not do {operation}({arguments}): {OPERATIONS[operation]}"


def _operation(error: BaseException) -> tuple[str | None, str]:
    """The outermost operation of :data:`OPERATIONS` in the traceback, and its numbers and texts as ``name=value``."""
    for frame, _ in traceback.walk_tb(error.__traceback__):
        if frame.f_code.co_name in OPERATIONS and "cadquery" in Path(frame.f_code.co_filename).parts:
            return frame.f_code.co_name, _arguments(frame)
    return None, ""


def _arguments(frame: FrameType) -> str:
    code = frame.f_code
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    plain = [(name, frame.f_locals.get(name)) for name in names]
    values = [f"{name}={value:g}" for name, value in plain if isinstance(value, int | float) and value is not True]
    return ", ".join(values[:SHOWN])
