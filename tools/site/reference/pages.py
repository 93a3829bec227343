"""The pages of the reference, and their index."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from tools.site.reference.contents import DOORS, MACHINES, contents
from tools.site.reference.entries import entry
from tools.site.reference.words import text

INDEX = """# Names of mbsd

Every public name, from the docstrings of the sources: SI units, radians, counter-clockwise; `(T,)` is a value at
each of T times.

| page | names |
|---|---|
"""
OF_MACHINES = """Each is imported from its own file, as [Engines](../docs/engines.md) and
[The hip thrust](../docs/hip_thrust.md) show.

"""


def write_reference(folder: Path) -> None:
    """Write the pages into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    for page, (title, names) in contents().items():
        (folder / page).write_text(f"# {title}\n\n{_introduction(page)}{_entries(names)}")
    (folder / "README.md").write_text(_index())


def _index() -> str:
    rows = (
        f"| [{title}]({page}) | {', '.join(f'[`{name}`]({_address(page, name, names)})' for name in names)} |\n"
        for page, (title, names) in contents().items()
    )
    return INDEX + "".join(rows)


def _address(page: str, name: str, names: dict[str, Any]) -> str:
    """Where a name is; a class alone on its page is the page."""
    return f"{page}#{name}" if len(names) > 1 else page


def _introduction(page: str) -> str:
    if page not in DOORS:
        return OF_MACHINES if page == MACHINES else ""
    module = DOORS[page][0]
    return f"`from {module} import ...`\n\n{text(importlib.import_module(module).__doc__)}\n\n"


def _entries(names: dict[str, Any]) -> str:
    """A section for each class and function; constants are a table at the end."""
    constants = {name: value for name, value in names.items() if not callable(value)}
    out = [entry(name, value, len(names) == 1) for name, value in names.items() if name not in constants]
    if constants:
        rows = "\n".join(f"| `{name}`{{ #{name} }} | `{_short(value)}` |" for name, value in constants.items())
        out.append(f"## Constants\n\n| name | value |\n|---|---|\n{rows}\n")
    return "\n".join(out)


def _short(value: Any) -> str:
    written = repr(value)
    return written if len(written) < 80 else f"a {type(value).__name__}"
