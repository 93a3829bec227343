"""Reference of the site: which names are on which page, and a section for each class and function."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator
from functools import cache, cached_property
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

from shared.stage.console import markdown_table
from shared.stage.paths import ROOT

# Which names are on which page of the reference.


ROOMS: dict[str, tuple[str, tuple[str, ...]]] = {
    "mechanism.md": ("Mechanism", ("mbsd.mechanism",)),
    "elements.md": ("Bodies, joints, forces", ("mbsd.model.body", "mbsd.model.joint", "mbsd.model.force")),
    "laws.md": ("Laws, curves and outlines", ("mbsd.model.laws", "mbsd.model.outlines")),
    "gas.md": ("Gas of engines", ("mbsd.model.cylinders",)),
    "events.md": ("Events", ("mbsd.model.event", "mbsd.dynamics")),
    "results.md": ("Results", ("mbsd.results", "mbsd.analyses", "mbsd.kinematics")),
    "pictures.md": ("Pictures", ("mbsd.pictures", "mbsd.drawing")),
    "design.md": (
        "Balancing, tolerances, derivatives, synthesis, studies",
        ("mbsd.balancing", "mbsd.tolerancing", "mbsd.derivatives", "mbsd.synthesis", "mbsd.studies"),
    ),
    "errors.md": ("Errors and warnings", ("mbsd.base",)),
}
"""Names of ``mbsd`` by the room in which they are made."""
CONSTANTS = "mbsd.model.body"
"""Where constants are listed, which do not say where they are made."""
DOORS = {
    "cams.md": ("mbsd.cams", "Cams"),
    "extend.md": ("mbsd.extend", "Kinds of your own"),
    "extend_derivatives.md": ("mbsd.extend.derivatives", "Derivatives in coordinates of your own"),
    "extend_integrators.md": ("mbsd.extend.integrators", "Integrators of your own"),
    "testing.md": ("mbsd.testing", "Tests of your own kinds"),
}
"""Modules beside ``mbsd`` whose names users import."""
MACHINES = "machines.md"
"""Page of names that the documents import from ``mbsd.machines``, which has no door of its own."""
PAGES = ("README.md", *ROOMS, *DOORS, MACHINES)
IMPORTED = re.compile(r"^from (mbsd\.machines[\w.]*) import (\([^)]*\)|[^\n]+)", re.MULTILINE)


def contents() -> dict[str, tuple[str, dict[str, Any]]]:
    """Title and names of every page. Raises ValueError where a public name is on none."""
    out, left = _of_rooms()
    if left:
        raise ValueError(f"no page of the reference has {', '.join(left)}; give their room to one (ROOMS)")
    for page, (module, title) in DOORS.items():
        door = importlib.import_module(module)
        out[page] = title, {name: getattr(door, name) for name in door.__all__}
    return out | {MACHINES: ("Engines and figures", _machines())}


def _of_rooms() -> tuple[dict[str, tuple[str, dict[str, Any]]], list[str]]:
    """The pages of the names of ``mbsd``, and the names that are on none."""
    mbsd = importlib.import_module("mbsd")
    left = {name: getattr(mbsd, name) for name in mbsd.__all__}
    out: dict[str, tuple[str, dict[str, Any]]] = {}
    for page, (title, rooms) in ROOMS.items():
        names = {name: value for name, value in left.items() if _made_in(value).startswith(rooms)}
        out[page] = title, names
        left = {name: value for name, value in left.items() if name not in names}
    return out, list(left)


def _made_in(value: Any) -> str:
    module = getattr(value, "__module__", None)
    return module if isinstance(module, str) else CONSTANTS


def _machines() -> dict[str, Any]:
    documents = "\n".join(path.read_text() for path in sorted((ROOT / "docs").glob("*.md")))
    return {
        name: getattr(importlib.import_module(module), name)
        for module, names in sorted(set(IMPORTED.findall(documents)))
        for name in sorted(re.findall(r"\w+", names))
    }


# Docstrings and signatures as Markdown.


ROLE = re.compile(r":(?:func|meth|class|mod|attr):`([^`]+)`")
CODE = re.compile(r"(`+[^`]*`+)")
WIDEST = 88


def text(doc: str | None) -> str:
    """A docstring as Markdown: examples stay code, names code, and what looks like a tag is no tag."""
    lines = inspect.cleandoc(doc or "").splitlines()
    return "\n".join(line if line.startswith("    ") else _prose(line) for line in _apart(lines))


def _apart(lines: list[str]) -> list[str]:
    """A blank line where code begins or ends."""
    out: list[str] = []
    for line in lines:
        if out and out[-1] and line and line.startswith("    ") != out[-1].startswith("    "):
            out.append("")
        out.append(line)
    return out


def _prose(line: str) -> str:
    pieces = CODE.split(ROLE.sub(lambda match: f"`{match[1].rpartition('.')[2]}`", line))
    pieces[::2] = [piece.replace("<", "&lt;").replace("*", "\\*") for piece in pieces[::2]]
    return "".join(pieces)


def first_sentence(doc: str | None) -> str:
    """The first paragraph of a docstring on a line of a table."""
    return " ".join(text(doc).partition("\n\n")[0].split()).replace("|", "\\|")


def signature(name: str, function: Callable[..., Any], bound: bool = False) -> str:
    """Return ``name(arguments) -> result``, over several lines where it is long.

    ``bound`` leaves the first argument out.
    """
    described = inspect.signature(function)
    parameters = [p for p in list(described.parameters.values())[1 if bound else 0 :] if not _of_the_class(p)]
    words = _marked(parameters)
    back = described.return_annotation
    tail = "" if back is inspect.Signature.empty else f" -> {_type(back)}"
    line = f"{name}({', '.join(words)}){tail}"
    return line if len(line) <= WIDEST else f"{name}(\n    " + ",\n    ".join(words) + f",\n){tail}"


def _of_the_class(parameter: inspect.Parameter) -> bool:
    """Return True if a dataclass makes this by itself: nobody gives it."""
    return repr(parameter.default) == "<factory>"


def _marked(parameters: list[inspect.Parameter]) -> list[str]:
    """Each parameter as it is written, with the star before those that are given by name alone."""
    out: list[str] = []
    for parameter in parameters:
        if parameter.kind is parameter.KEYWORD_ONLY and "*" not in out and not any(w.startswith("*") for w in out):
            out.append("*")
        out.append(_parameter(parameter))
    return out


def _parameter(parameter: inspect.Parameter) -> str:
    stars = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
    word = stars + parameter.name
    if parameter.annotation is not parameter.empty:
        word += f": {_type(parameter.annotation)}"
    if parameter.default is not parameter.empty:
        word += f" = {_value(parameter.default)}"
    return word


def _type(annotation: Any) -> str:
    return annotation if isinstance(annotation, str) else getattr(annotation, "__name__", str(annotation))


def _value(default: Any) -> str:
    written = repr(default)
    return "..." if written.startswith("<") or len(written) > 40 else written


# What a class has for its users: fields with the strings below them, methods under the comments that group them.


GROUP = re.compile(r"^    # -- (.+?) -+$")


class Member(NamedTuple):
    """A field, property or method."""

    group: str
    name: str
    kind: str
    """field, property or method."""
    type: str
    doc: str
    value: Any


def members(owner: type) -> list[Member]:
    """Public ones in the order of their files, those of base classes first."""
    out: dict[str, Member] = {}
    for base in reversed(owner.__mro__):
        if base.__module__.startswith("mbsd."):
            out |= {member.name: member for member in _own(base)}
    return list(out.values())


def _own(owner: type) -> Iterator[Member]:
    for name, group, node, doc in _written(owner):
        if name.startswith("_"):
            continue
        value = inspect.getattr_static(owner, name, None)
        if isinstance(value, property | cached_property):
            back = (value.fget if isinstance(value, property) else value.func).__annotations__.get("return", "")
            yield Member(group, name, "property", str(back), inspect.getdoc(value) or "", value)
        elif isinstance(value, classmethod | staticmethod) or inspect.isfunction(value):
            plain = value.__func__ if isinstance(value, classmethod | staticmethod) else value
            yield Member(group, name, "method", "", inspect.getdoc(plain) or "", value)
        elif isinstance(node, ast.AnnAssign):
            yield Member(group, name, "field", ast.unparse(node.annotation), doc, value)


def _written(owner: type) -> Iterator[tuple[str, str, ast.stmt, str]]:
    """Name, group, statement and the string below it, of each name that the body of a class binds."""
    lines, start, body = _body(owner)
    groups = [(start + k, match[1]) for k, line in enumerate(lines) if (match := GROUP.match(line))]
    for node, after in zip(body, [*body[1:], None], strict=True):
        group = next((name for line, name in reversed(groups) if line < start + node.lineno - 1), "")
        for name in _names(node):
            yield name, group, node, _string(after)


@cache
def _body(owner: type) -> tuple[list[str], int, list[ast.stmt]]:
    lines, start = inspect.getsourcelines(owner)
    (tree,) = ast.parse(textwrap.dedent("".join(lines))).body
    assert isinstance(tree, ast.ClassDef)
    return lines, start, tree.body


def _names(node: ast.stmt) -> list[str]:
    if isinstance(node, ast.FunctionDef):
        return [node.name]
    targets = [node.target] if isinstance(node, ast.AnnAssign) else node.targets if isinstance(node, ast.Assign) else []
    return [target.id for target in targets if isinstance(target, ast.Name)]


def _string(node: ast.stmt | None) -> str:
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
        return inspect.cleandoc(node.value.value)
    return ""


def file_of(value: Any) -> str:
    """The file of a class or function, as in the clone."""
    return Path(inspect.getfile(inspect.unwrap(value))).relative_to(ROOT).as_posix()


# The section of a class or a function: how it is called, what it says of itself, what it has.


GIVEN_BACK = (
    "mbsd.results",
    "mbsd.analyses",
    "mbsd.kinematics",
    "mbsd.model",
    "mbsd.dynamics",
    "mbsd.drawing",
    "mbsd.pictures",
)
"""Rooms whose classes a call gives back: nobody makes one, so the table of their fields is enough."""
CALLED = {"Mechanism": "m.", "Solution": "sol."}
"""Names that the documents give to an instance."""


def entry(name: str, value: Any, alone: bool = False) -> str:
    """The section; of a class that is ``alone`` on its page the page is the section."""
    if inspect.isclass(value):
        return _class(name, value, alone)
    words = code(signature(name, _plain(value)))
    return f"{heading('##', name)}\n\n{words}\n\n{text(inspect.getdoc(value))}\n\n{_source(value)}"


def heading(level: str, name: str, owner: str = "") -> str:
    """A heading whose anchor is the name as it is written: ``curve`` is not ``Curve``."""
    return f"{level} {name} {{ #{owner}{name} }}"


def code(words: str) -> str:
    """A block of Python."""
    return f"```python\n{words}\n```"


def _plain(value: Callable[..., Any]) -> Callable[..., Any]:
    """A kernel's Python."""
    return getattr(value, "py_func", value)


def _source(value: Any) -> str:
    try:
        return f"`{file_of(_plain(value))}`{{ .source }}\n"
    except (TypeError, ValueError, OSError):
        return ""


def _class(name: str, owner: type, alone: bool) -> str:
    parts = [] if alone else [heading("##", name)]
    if issubclass(owner, BaseException):
        parts += [f"A kind of `{owner.__mro__[1].__name__}`.", text(owner.__doc__)]
    else:
        made = [] if owner.__module__.startswith(GIVEN_BACK) else [code(f"class {_signature(name, owner)}")]
        parts += [*made, text(owner.__doc__), _source(owner), *_members(name, owner, "##" if alone else "###")]
    return "\n\n".join(part for part in parts if part) + "\n"


def _signature(name: str, owner: type) -> str:
    try:
        return signature(name, owner).removesuffix(" -> None")
    except (TypeError, ValueError):
        return name


def _members(name: str, owner: type, level: str) -> Iterator[str]:
    everything = members(owner)
    if data := [member for member in everything if member.kind != "method"]:
        yield _table(data)
    methods = [member for member in everything if member.kind == "method"]
    groups = [member.group for member in methods]
    for group, inside in groupby(sorted(methods, key=lambda member: groups.index(member.group)), lambda m: m.group):
        if group:
            yield f"{level} {group[0].upper()}{group[1:]} {{ #{name}-{group.partition(',')[0].replace(' ', '-')} }}"
        for member in inside:
            yield _method(name, member, level + "#" * bool(group))


def _table(data: list[Member]) -> str:
    rows = [(f"`{m.name}`", f"`{m.type}`", first_sentence(m.doc)) for m in data]
    return "\n".join(markdown_table(("name", "type", "what"), rows))


def _method(owner: str, member: Member, level: str) -> str:
    value = member.value.__func__ if isinstance(member.value, classmethod | staticmethod) else member.value
    words = code(CALLED.get(owner, "") + signature(member.name, value, not isinstance(member.value, staticmethod)))
    return f"{heading(level, member.name, f'{owner}.')}\n\n{words}\n\n{text(member.doc)}"


# The pages of the reference, and their index.


INDEX = """# Names of mbsd

Every public name, from the docstrings of the sources: SI units, radians, counter-clockwise; `(T,)` is a value at
each of T times.

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
    rows = [
        (f"[{title}]({page})", ", ".join(f"[`{name}`]({_address(page, name, names)})" for name in names))
        for page, (title, names) in contents().items()
    ]
    return INDEX + "\n".join(markdown_table(("page", "names"), rows)) + "\n"


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
        rows = [(f"`{name}`{{ #{name} }}", f"`{_short(value)}`") for name, value in constants.items()]
        table = "\n".join(markdown_table(("name", "value"), rows))
        out.append(f"## Constants\n\n{table}\n")
    return "\n".join(out)


def _short(value: Any) -> str:
    written = repr(value)
    return written if len(written) < 80 else f"a {type(value).__name__}"
