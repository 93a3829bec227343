"""What the C sources need to know of a mechanism: memory, tables, variables, frames and joints, as a header."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from mbsd.dynamics import state as run_state
from mbsd.equations.interactions.switching import WIDTH
from mbsd.native import quantities as native
from mbsd.native.quantities import INPUT, PARAMETER, STATE, Quantity

DRIFT = 1e-9
"""Drift of an importer's steps in sizes or rad, beyond which the unit asks for an event that projects it away."""
FAR = 0.05
"""A start that moves by more to fulfil the constraints is refused (sizes, rad)."""
CODES = {
    native: ("FRAME", "JOINT", "DRIVER", "ENERGY", "MASS", "INERTIA", "GRAVITY", "RATE", "LOAD"),
    run_state: ("TIME", "STEP", "WORK", "POWER", "STARTED", "REACHED", "PAUSED", "STEP_TOO_SMALL"),
}
"""Codes that Python and C share: kinds of quantities, entries of clock and count, what advance returns."""
ENTRIES = ("advance", "derivative", "project", "jacobian")


def data_header(
    equations: Any, quantities: Sequence[Quantity], frames: Sequence[tuple[int, float, float, float]]
) -> str:
    """The text of model.h; its token is still to be put in."""
    packed, tables = equations.ready.packed, {entry: equations.table(entry) for entry in ENTRIES}
    reals = {"START_TIME": equations.ready.start, "TOLERANCE": equations.tolerance, "DRIFT": DRIFT, "FAR": FAR}
    numbers = {**_counts(equations, quantities), **_places(equations), **_scalars(tables)}
    lines = ["/* The mechanism's numbers; written by mbsd. */", f'#define MODEL_NAME "{_text(packed.name)}"']
    lines += ['#define TOKEN "@TOKEN@"', *(f"#define {name} {_real(value)}" for name, value in reals.items())]
    lines += [f"#define {name} {number}" for name, number in numbers.items()]
    codes = {name: getattr(module, name) for module, names in CODES.items() for name in names}
    codes["LAST_ERROR"] = run_state.ERROR
    lines.append(f"enum {{ {', '.join(f'{name} = {code}' for name, code in codes.items())} }};")
    content = equations.memory.content
    words = np.frombuffer(content.ljust(-(-len(content) // 8) * 8, b"\0"), np.uint64).tolist()
    lines.append(_array("uint64_t", "MEMORY", [f"UINT64_C({word:#x})" if word else "0" for word in words]))
    for entry, table in tables.items():
        flat = [word for part in table.values() for word in part]
        lines.append(f"#define {entry.upper()}_WORDS {len(flat)}")
        rows = [f"{{INT64_C({word.value}), {int(word.place)}}}" for word in flat]
        lines.append(_array("Word", f"{entry.upper()}_TABLE", rows))
    variables = [f"{{{q.kind}, {q.index}, {q.component}, {q.place}, {_real(q.start)}}}" for q in quantities]
    lines.append(_array("Variable", "VARIABLE", variables))
    lines.append(_array("char *const", "NAME", [f'"{_text(q.name)}"' for q in quantities]))
    lines.append(_array("double", "NOMINAL", [_real(q.size) for q in quantities if q.role == STATE]))
    lines.append(_array("Frame", "FRAME_OF", [f"{{{b}, {_real(x)}, {_real(y)}, {_real(a)}}}" for b, x, y, a in frames]))
    lines.append(_array("Joint", "JOINT_OF", list(_joints(packed))))
    lines.append(_array("double", "STOP_BEFORE", [_real(t) for t in equations.stops.before.tolist()]))
    lines.append(_array("double", "STOP_AFTER", [_real(t) for t in equations.stops.after.tolist()]))
    return "\n".join([*lines, _relocations(equations.functions()), ""])


def _counts(equations: Any, quantities: Sequence[Quantity]) -> dict[str, int]:
    packed, dynamics = equations.ready.packed, equations.ready.dynamics
    roles = [quantity.role for quantity in quantities]
    return {
        "N3": len(dynamics.inertia),
        "BODIES": len(packed.body_names) - packed.states,
        "DRIVER_ROWS": packed.driver_rows,
        "SWITCHES": len(dynamics.loads.switch),
        "SWITCH_WIDTH": WIDTH,
        "VARIABLES": len(quantities),
        "STATES": roles.count(STATE),
        "INPUTS": roles.count(INPUT),
        "PARAMETERS": roles.count(PARAMETER),
        "STOPS": len(equations.stops.before),
        "MEMORY_SIZE": len(equations.memory.content),
    }


def _places(equations: Any) -> dict[str, int]:
    """Where the arrays are that the C sources read and write, in bytes from the start of the memory."""
    packed, dynamics, run, state = equations.ready.packed, equations.ready.dynamics, equations.run, equations.state
    arrays = {
        "Y": state.y, "DY": state.dy, "LAM": state.lam, "CLOCK": state.clock, "COUNT": state.count,
        "JACOBIAN": equations.jacobian_at, "DRIVE": run.scratch.drive, "REPORT": run.scratch.report,
        "SWITCH": dynamics.loads.switch, "INERTIA": dynamics.inertia, "INVERSE": dynamics.inverse,
        "METRIC": dynamics.metric, "WEIGHT": dynamics.weight, "GRAVITY": packed.system.gravity,
        "MASS": packed.system.mass, "TURNING": packed.system.inertia, "ABSOLUTE": run.settings.absolute,
        "GROWING": run.settings.growing,
    }  # fmt: skip
    return {f"AT_{name}": equations.memory.offset(array) for name, array in arrays.items()}


def _scalars(tables: dict[str, dict[str, list[Any]]]) -> dict[str, int]:
    """Where the numbers stand in the tables that change from call to call; see NativeEquations.arguments."""
    places = {
        "ADVANCE_END": ("advance", "5"), "ADVANCE_STEPS": ("advance", "6"),
        "ADVANCE_RELATIVE": ("advance", "4.relative"), "DERIVATIVE_TIME": ("derivative", "2"),
        "PROJECT_TIME": ("project", "2"), "PROJECT_PASSES": ("project", "4"),
    }  # fmt: skip
    return {name: _word(tables[entry], path) for name, (entry, path) in places.items()}


def _word(table: dict[str, list[Any]], path: str) -> int:
    """Where a number stands in a table."""
    at = 0
    for name, words in table.items():
        if name == path:
            return at
        at += len(words)
    raise KeyError(path)


def _joints(packed: Any) -> Iterable[str]:
    """One line for each joint; see wrenches in mbsd/arrays/reactions.py."""
    system = packed.system
    for (i, j), first, last in zip(packed.markers, packed.first_row, packed.first_row[1:], strict=False):
        carrier = int(system.marker_body[j])
        x, y = system.marker_arm[j].tolist()
        body = carrier or int(system.marker_body[i])
        yield f"{{{body}, {int(carrier > 0)}, {carrier}, {_real(x)}, {_real(y)}, {first}, {last}}}"


def _relocations(functions: Sequence[tuple[int, str]]) -> str:
    """The function that writes addresses of functions into the memory."""
    names = sorted({name for _, name in functions})
    lines = [f"extern void *const {name};" for name in names]
    lines.append("static inline void relocate(unsigned char *memory) {\n    (void)memory;")
    lines += [f"    *(int64_t *)(memory + {place}) = (int64_t)(intptr_t){name};" for place, name in functions]
    return "\n".join([*lines, "}"])


def _array(kind: str, name: str, items: Sequence[str]) -> str:
    """A constant; one of no items has one of zeros, which nobody reads."""
    rows = ",\n".join(", ".join(items[k : k + 8]) for k in range(0, len(items), 8)) or "{0}" if items else "0"
    if not items and kind in ("Frame", "Joint", "Word", "Variable"):
        rows = "{0}"
    return f"static const {kind} {name}[] = {{\n{rows}}};"


def _real(value: float) -> str:
    return float(value).hex() if np.isfinite(value) else "0.0"


def _text(value: str) -> str:
    return value.replace("\\", "\\\\").replace('"', '\\"')
