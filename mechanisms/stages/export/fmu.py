"""Functional mock-up units: the description, the arrays of the model, and the archive."""

from __future__ import annotations

import hashlib
import io
import os
import platform
import re
import shutil
import subprocess
import tempfile
import zipfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from mbsd.dynamics import state as run_state
from mbsd.equations.interactions.switching import WIDTH
from mbsd.native import quantities as native
from mbsd.native.quantities import INPUT, OUTPUT, PARAMETER, RATE, STATE, Quantity
from shared.stage.errors import UserError

# The header that describes a mechanism to the C sources: memory, tables, variables, frames and joints, as a header.

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
    """Return the text of model.h; its token is still to be put in."""
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
    """Return where the arrays of the C sources are, in bytes from the start of the memory."""
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
    """Return where the numbers stand in the tables that change from call to call.

    See NativeEquations.arguments.
    """
    places = {
        "ADVANCE_END": ("advance", "5"), "ADVANCE_STEPS": ("advance", "6"),
        "ADVANCE_RELATIVE": ("advance", "4.relative"), "DERIVATIVE_TIME": ("derivative", "2"),
        "PROJECT_TIME": ("project", "2"), "PROJECT_PASSES": ("project", "4"),
    }  # fmt: skip
    return {name: _word(tables[entry], path) for name, (entry, path) in places.items()}


def _word(table: dict[str, list[Any]], path: str) -> int:
    """Return where a number stands in a table."""
    at = 0
    for name, words in table.items():
        if name == path:
            return at
        at += len(words)
    raise KeyError(path)


def _joints(packed: Any) -> Iterable[str]:
    """Yield one line for each joint; see wrenches in mbsd/arrays/reactions.py."""
    system = packed.system
    for (i, j), first, last in zip(packed.markers, packed.first_row, packed.first_row[1:], strict=False):
        carrier = int(system.marker_body[j])
        x, y = system.marker_arm[j].tolist()
        body = carrier or int(system.marker_body[i])
        yield f"{{{body}, {int(carrier > 0)}, {carrier}, {_real(x)}, {_real(y)}, {first}, {last}}}"


def _relocations(functions: Sequence[tuple[int, str]]) -> str:
    """Return the function that writes addresses of functions into the memory."""
    names = sorted({name for _, name in functions})
    lines = [f"extern void *const {name};" for name in names]
    lines.append("static inline void relocate(unsigned char *memory) {\n    (void)memory;")
    lines += [f"    *(int64_t *)(memory + {place}) = (int64_t)(intptr_t){name};" for place, name in functions]
    return "\n".join([*lines, "}"])


def _array(kind: str, name: str, items: Sequence[str]) -> str:
    """Return a constant; one of no items has one of zeros, which nobody reads."""
    rows = ",\n".join(", ".join(items[k : k + 8]) for k in range(0, len(items), 8)) or "{0}" if items else "0"
    if not items and kind in ("Frame", "Joint", "Word", "Variable"):
        rows = "{0}"
    return f"static const {kind} {name}[] = {{\n{rows}}};"


def _real(value: float) -> str:
    return float(value).hex() if np.isfinite(value) else "0.0"


def _text(value: str) -> str:
    return value.replace("\\", "\\\\").replace('"', '\\"')


# modelDescription.xml: units, variables with their value references, and what depends on what.
#
# Source: FMI 3.0, section 2.4.

KINDS = {"kg": {"kg": 1}, "m": {"m": 1}, "rad": {"rad": 1}, "s": {"s": 1}, "s2": {"s": 2}, "m2": {"m": 2},
         "N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}}  # fmt: skip
"""Exponents of the base units."""
CAUSALITY = {STATE: "local", INPUT: "input", PARAMETER: "parameter", OUTPUT: "output"}


def description(
    name: str, token: str, identifier: str, quantities: Sequence[Quantity], span: tuple[float, float, float],
    tolerance: float, early: bool, exchange: bool,
) -> str:  # fmt: skip
    """Return the text. ``span``: start, end and step (s).

    ``early``: whether a step may end where contacts begin and end; ``exchange``: whether the unit may be integrated by
    the importer.
    """
    root = Element("fmiModelDescription", fmiVersion="3.0", modelName=name, instantiationToken=token,
                   description=f"{name}, a planar mechanism", generationTool="mbsd",
                   variableNamingConvention="flat")  # fmt: skip
    able = {"modelIdentifier": identifier, "needsExecutionTool": "false", "canGetAndSetFMUState": "true",
            "canSerializeFMUState": "true"}  # fmt: skip
    if exchange:
        SubElement(root, "ModelExchange", able)
    steps = {"canHandleVariableCommunicationStepSize": "true"}
    if early:
        steps["mightReturnEarlyFromDoStep"] = "true"
    SubElement(root, "CoSimulation", able | steps)
    _units(root, quantities)
    categories = SubElement(root, "LogCategories")
    for category in ("logStatusWarning", "logStatusError"):
        SubElement(categories, "Category", name=category)
    start, end, step = span
    SubElement(root, "DefaultExperiment", startTime=repr(start), stopTime=repr(end), stepSize=repr(step),
               tolerance=repr(tolerance))  # fmt: skip
    _variables(root, quantities)
    _structure(root, quantities)
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _units(root: Element, quantities: Sequence[Quantity]) -> None:
    units = SubElement(root, "UnitDefinitions")
    for name in sorted({"s", *(quantity.unit for quantity in quantities)}):
        SubElement(SubElement(units, "Unit", name=name), "BaseUnit", _exponents(name))


def _exponents(unit: str) -> dict[str, str]:
    """Return exponents of the base units in a unit like N.m/rad."""
    above, _, below = unit.partition("/")
    out: dict[str, int] = {}
    for side, parts in ((1, above), (-1, below)):
        for part in filter(None, parts.split(".")):
            for base, exponent in KINDS[part].items():
                out[base] = out.get(base, 0) + side * exponent
    return {base: str(exponent) for base, exponent in out.items() if exponent}


def _variables(root: Element, quantities: Sequence[Quantity]) -> None:
    variables = SubElement(root, "ModelVariables")
    SubElement(variables, "Float64", name="time", valueReference="0", causality="independent",
               variability="continuous", unit="s")  # fmt: skip
    references = {quantity.name: k for k, quantity in enumerate(quantities, 1)}
    for reference, quantity in enumerate(quantities, 1):
        said = {"name": quantity.name, "valueReference": str(reference), "causality": CAUSALITY[quantity.role],
                "variability": _variability(quantity), "unit": quantity.unit}  # fmt: skip
        if quantity.words:
            said["description"] = quantity.words
        if quantity.role == STATE:
            said["initial"] = "exact"
        if quantity.role != OUTPUT:
            said["start"] = repr(float(quantity.start))
        if quantity.rate_of:
            said["derivative"] = str(references[quantity.rate_of])
        SubElement(variables, "Float64", said)


def _variability(quantity: Quantity) -> str:
    if quantity.role == PARAMETER:
        return "fixed"
    return "discrete" if quantity.kind == RATE else "continuous"


def _structure(root: Element, quantities: Sequence[Quantity]) -> None:
    structure = SubElement(root, "ModelStructure")
    for reference, quantity in enumerate(quantities, 1):
        if quantity.role == OUTPUT:
            SubElement(structure, "Output", valueReference=str(reference))
    for reference, quantity in enumerate(quantities, 1):
        if quantity.rate_of:
            SubElement(structure, "ContinuousStateDerivative", valueReference=str(reference))
    for reference, quantity in enumerate(quantities, 1):
        if quantity.role == OUTPUT:
            SubElement(structure, "InitialUnknown", valueReference=str(reference))


# The file: machine code of the equations, the C sources of the interface, both linked, and their description.
#
# Source: Functional Mock-up Interface 3.0, fmi-standard.org/docs/3.0 (section 2.5 for the archive).

RUNTIME = Path(__file__).parent / "fmi_runtime"
FLAGS = ("-std=c11", "-O2", "-fPIC", "-fvisibility=hidden", "-Wall", "-Wextra", "-Wno-unused-const-variable")
TOLERANCE = 1e-10
"""Tolerance of its own integrator, unless the importer says another."""
MACHINES = {"AMD64": "x86_64", "arm64": "aarch64"}
SYSTEMS = {"Linux": "linux", "Darwin": "darwin", "Windows": "windows"}
ENDINGS = {"Linux": ".so", "Darwin": ".dylib", "Windows": ".dll"}
DATED = (1980, 1, 1, 0, 0, 0)
"""The same bytes from the same inputs."""


def fmu(solution: Any) -> tuple[bytes, list[str]]:
    """Return the archive, and what it leaves out.

    Raises UserError without a C compiler or for what needs Python.
    """
    from mbsd import ModelError
    from mbsd.native.equations import NativeEquations
    from mbsd.native.quantities import frames_of, quantities_of, with_inputs

    m, times = solution.mechanism, solution.t
    compiler = _compiler(m.name)
    try:
        equations = NativeEquations(with_inputs(m), float(times[0]), float(times[-1]), TOLERANCE)
        assembly = equations.assembly()
    except ModelError as error:
        raise UserError(f"{error} (an FMU contains machine code alone)") from error
    quantities = quantities_of(equations)
    header = data_header(equations, quantities, frames_of(equations))
    token = "{" + hashlib.sha256((assembly + header).encode()).hexdigest()[:32] + "}"
    header, identifier = header.replace("@TOKEN@", token), _identifier(m.name)
    span = float(times[0]), float(times[-1]), float(times[1] - times[0])
    words = description(m.name, token, identifier, quantities, span, TOLERANCE, equations.switches, equations.exchange)
    files = {
        "modelDescription.xml": words.encode(),
        f"binaries/{_platform()}/{identifier}{ENDINGS[platform.system()]}": _linked(m.name, compiler, assembly, header),
        "sources/model.h": header.encode(),
        f"extra/mbsd/kernels-{_platform()}.s": assembly.encode(),
    }
    files |= {f"sources/{file.name}": file.read_bytes() for file in RUNTIME.iterdir() if file.suffix in (".c", ".h")}
    return _archive(files), equations.left_out


def _compiler(name: str) -> str:
    """Return the C compiler: CC, else what the system calls cc, gcc or clang.

    Raises UserError where there is none.
    """
    for command in (os.environ.get("CC", ""), "cc", "gcc", "clang"):
        where = command and shutil.which(command)
        if where:
            return where
    raise UserError(f"{name}: an FMU needs a C compiler (cc), and there is none; install one: apt-get install gcc")


def _linked(name: str, compiler: str, assembly: str, header: str) -> bytes:
    """Return the shared library. Raises UserError with the compiler's words where it fails."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        for file in RUNTIME.iterdir():
            shutil.copy(file, place)
        (place / "model.h").write_text(header)
        (place / "kernels.s").write_text(assembly)
        sources = sorted(file.name for file in RUNTIME.iterdir() if file.suffix == ".c")
        command = [compiler, *FLAGS, "-shared", "-o", "unit", *sources, "kernels.s", "-lm"]
        done = subprocess.run(command, cwd=place, capture_output=True, text=True, check=False)
        if done.returncode:
            raise UserError(f"{name}: {compiler} cannot compile the FMU: {done.stderr.strip()[-600:]}")
        return (place / "unit").read_bytes()


def _platform() -> str:
    """Return the name of the folder of this platform's binaries.

    Raises UserError for one that the standard does not name.
    """
    machine, system = platform.machine(), platform.system()
    if system not in SYSTEMS:
        raise UserError(f"FMI has no name for the system {system}; export on Linux, macOS or Windows")
    return f"{MACHINES.get(machine, machine)}-{SYSTEMS[system]}"


def _identifier(name: str) -> str:
    """Return the mechanism's name as one of C."""
    made = re.sub(r"\W", "_", name, flags=re.ASCII)
    return made if made[:1].isalpha() else f"m_{made}"


def _archive(files: dict[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name, DATED), part, zipfile.ZIP_DEFLATED)
    return content.getvalue()
