"""Docstrings and signatures as Markdown."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any

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
    """``name(arguments) -> result``, over several lines where it is long; ``bound`` leaves the first argument out."""
    described = inspect.signature(function)
    parameters = [p for p in list(described.parameters.values())[1 if bound else 0 :] if not _of_the_class(p)]
    words = _marked(parameters)
    back = described.return_annotation
    tail = "" if back is inspect.Signature.empty else f" -> {_type(back)}"
    line = f"{name}({', '.join(words)}){tail}"
    return line if len(line) <= WIDEST else f"{name}(\n    " + ",\n    ".join(words) + f",\n){tail}"


def _of_the_class(parameter: inspect.Parameter) -> bool:
    """Whether a dataclass makes this by itself: nobody gives it."""
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
