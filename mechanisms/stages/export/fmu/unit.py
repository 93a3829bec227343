"""The file: machine code of the equations, the C sources of the interface, both linked, and their description.

Source: Functional Mock-up Interface 3.0, fmi-standard.org/docs/3.0 (section 2.5 for the archive).
"""

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
from pathlib import Path
from typing import Any

from mechanisms.stages.export.fmu.data import data_header
from mechanisms.stages.export.fmu.description import description
from shared.stage.errors import UserError

RUNTIME = Path(__file__).parent / "runtime"
FLAGS = ("-std=c11", "-O2", "-fPIC", "-fvisibility=hidden", "-Wall", "-Wextra", "-Wno-unused-const-variable")
TOLERANCE = 1e-10
"""Tolerance of its own integrator, unless the importer says another."""
MACHINES = {"AMD64": "x86_64", "arm64": "aarch64"}
SYSTEMS = {"Linux": "linux", "Darwin": "darwin", "Windows": "windows"}
ENDINGS = {"Linux": ".so", "Darwin": ".dylib", "Windows": ".dll"}
DATED = (1980, 1, 1, 0, 0, 0)
"""The same bytes from the same inputs."""


def fmu(solution: Any) -> tuple[bytes, list[str]]:
    """The archive, and what it leaves out. Raises UserError without a C compiler or for what needs Python."""
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
    """The C compiler: CC, else what the system calls cc, gcc or clang. Raises UserError where there is none."""
    for command in (os.environ.get("CC", ""), "cc", "gcc", "clang"):
        where = command and shutil.which(command)
        if where:
            return where
    raise UserError(f"{name}: an FMU needs a C compiler (cc), and there is none; install one: apt-get install gcc")


def _linked(name: str, compiler: str, assembly: str, header: str) -> bytes:
    """The shared library. Raises UserError with the compiler's words where it fails."""
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
    """Name of the folder of this platform's binaries. Raises UserError for one that the standard does not name."""
    machine, system = platform.machine(), platform.system()
    if system not in SYSTEMS:
        raise UserError(f"FMI has no name for the system {system}; export on Linux, macOS or Windows")
    return f"{MACHINES.get(machine, machine)}-{SYSTEMS[system]}"


def _identifier(name: str) -> str:
    """The mechanism's name as one of C."""
    made = re.sub(r"\W", "_", name, flags=re.ASCII)
    return made if made[:1].isalpha() else f"m_{made}"


def _archive(files: dict[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name, DATED), part, zipfile.ZIP_DEFLATED)
    return content.getvalue()
