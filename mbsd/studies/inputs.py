"""Inputs of a study beside the content of build and measure; its results are kept with them."""

from __future__ import annotations

import functools
import inspect
import os
import time
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from mbsd.dependencies.imported import file_of, modules_below, package_of
from mbsd.dependencies.inputs import CHANGED, Inputs, Places, package_state
from mbsd.dependencies.installed import distributions, is_installed
from mbsd.dependencies.recorder import Recorder
from mbsd.studies.content import PACKAGE, Content

PACKAGES = ("numpy", "scipy", "numba", "llvmlite")
"""Installed packages that decide the numbers of every study."""
FOLDER = "the working folder"
"""A variable beside those of the environment: where relative paths lead, as seen from the root."""


class StudyPlaces(Places):
    """Files named relative to the folder of the script or module that defines build."""

    def is_program(self, file: str) -> bool:
        """True if a file is of mbsd."""
        return is_of_mbsd(file)

    def state(self, kind: str, name: str) -> str:
        """Return the present state of one input."""
        if (kind, name) == ("variables", FOLDER):
            return working_folder(self)
        return super().state(kind, name)


_PROGRAM = (str(PACKAGE) + os.sep, str(PACKAGE.resolve()) + os.sep)


def is_of_mbsd(file: str) -> bool:
    """True if a file is of this package."""
    return file.startswith(_PROGRAM)


def working_folder(places: Places) -> str:
    """Return the working folder as seen from the root."""
    return os.path.relpath(os.getcwd(), places.root)


def root_of(function: Callable[..., Any]) -> Path:
    """Return the folder of the user's file that defines a function; the working folder where it has none."""
    while isinstance(function, functools.partial):
        function = function.func
    function = inspect.unwrap(getattr(function, "__func__", function))
    defined = getattr(function, "__globals__", None) or getattr(type(function).__call__, "__globals__", {})
    file = defined.get("__file__")
    if not isinstance(file, str) or is_installed(os.path.abspath(file)):
        return Path.cwd()
    return Path(os.path.abspath(file)).parent


def loaded_inputs(content: Content, places: Places) -> Inputs:
    """Return user modules that count as a whole, and packages that build and measure reach.

    Modules come with their imports. A module whose file was written after this process began may be loaded as it was
    before: it counts as changed.
    """
    inputs = modules_below(
        [(file, package_of(module)) for module in content.whole.values() if (file := file_of(module)) is not None],
        places,
        _count,
    )
    for name in inputs.modules:
        if os.stat(places.path_of(name)).st_mtime > _begun():
            inputs.modules[name] = CHANGED
    for package in {*PACKAGES, *(name for top in content.packages for name in distributions(top))} - {*inputs.packages}:
        inputs.packages[package] = places.package_state(package)
    return inputs


@functools.cache
def _begun() -> float:
    """Return the time when this process began (s since the epoch).

    If the system does not tell, it is the time when this module was loaded.
    """
    try:
        ticks = float(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        up = float(Path("/proc/uptime").read_text().split()[0])
    except (OSError, ValueError, IndexError):
        return _LOADED
    return time.time() - up + ticks / os.sysconf("SC_CLK_TCK")


_LOADED = time.time()


def recorded_inputs(recorder: Recorder) -> Inputs:
    """Return the inputs that build and measure have read and loaded in this process."""
    inputs = recorder.inputs(every_module=True)
    here = str(Path.cwd()) + os.sep
    read = [*inputs.files, *inputs.folders]
    if any(str(recorder.places.path_of(name)).startswith(here) for name in read):
        inputs.variables[FOLDER] = working_folder(recorder.places)
    return inputs


def _count(module: ModuleType, inputs: Inputs, waiting: list[tuple[Path, str]]) -> None:
    file = file_of(module)
    if file is None or file.is_relative_to(PACKAGE):
        return
    if is_installed(str(file)):
        for name in distributions(module.__name__.partition(".")[0]):
            if name not in inputs.packages:  # to ask for a version takes milliseconds
                inputs.packages[name] = package_state(name)
    else:
        waiting.append((file, package_of(module)))
