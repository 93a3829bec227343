"""Names that people give the numbers of Params: ``tracer[0]`` is "tracer x", in m.

An author may say so, where one string serves all numbers of a tuple,

    wheel: tuple[float, float] = field(
        default=(0.8, 2e-3), metadata={"names": ("mass", "inertia"), "unit": ("kg", "kg m^2")}
    )

or in the comment beside the number: "# of a charge (J/m^3)", "# metres", "# crank, rod, slider". Where he says nothing,
the model does (decided.py).
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Mapping
from typing import Any

from shared.stage.paths import mechanism_file
from studio.live.child.author import Author
from studio.live.child.decided import decided_by
from studio.live.numbers import numbers_of, parsed

ATOM = r"(?:[mckM]?m|[kM]?g|t|m?s|min|h|rad|deg|[kM]?N|[kM]?J|[kM]?W|[kMG]?Pa|bar|[kM]?Hz|K|A|V)(?:\^?[2-4])?"
UNIT = re.compile(rf"{ATOM}(?:[ /]{ATOM})*")
WORDS = {"metres": "m", "millimetres": "mm", "kilograms": "kg", "seconds": "s", "degrees": "°", "radians": "rad"}
"""Units that people write out."""


def described(author: Author) -> dict[str, dict[str, str]]:
    """Return ``label`` and ``unit`` of each number of Params; a unit is empty if nothing gives it."""
    numbers = numbers_of(author.params)
    said, comments = _metadata(author.params), _comments(author)
    decided = decided_by(author, numbers)
    sizes: dict[str, int] = {}
    for number in numbers:
        field, _ = parsed(number.name)
        sizes[field] = sizes.get(field, 0) + 1
    out: dict[str, dict[str, str]] = {}
    counts: dict[str, int] = {}
    for number in numbers:
        field, places = parsed(number.name)
        k = counts[field] = counts.get(field, -1) + 1
        given, comment, size = said.get(field, {}), comments.get(field, ""), sizes[field]
        unit = _one_of(given.get("unit"), k) or _in_comment(comment, k, size) or decided.unit(number)
        label = field.replace("_", " ")
        if places:
            name = (
                _one_of(given.get("names"), k)
                or _listed(comment, k, size)
                or (size == 2 and decided.axis(number, k))
                or ""
            )
            label = f"{label} {name or k + 1}"
        whole = number.whole and not given.get("unit")
        out[number.name] = {"label": label, "unit": "" if whole else _printed(unit)}
    return out


def _printed(unit: str) -> str:
    for digit, raised in (("2", "²"), ("3", "³"), ("4", "⁴")):
        unit = unit.replace(f"^{digit}", raised)
    return "°" if unit == "deg" else unit


def _one_of(given: Any, k: int) -> str:
    if isinstance(given, str):
        return given
    return str(given[k]) if isinstance(given, tuple | list) and k < len(given) else ""


def _metadata(params: Any) -> dict[str, Mapping[str, Any]]:
    fields = getattr(params, "__dataclass_fields__", {})
    return {name: field.metadata for name, field in fields.items()}


def _comments(author: Author) -> dict[str, str]:
    """Return the comments behind the fields of Params in mechanism.py."""
    try:
        source = mechanism_file(author.name).read_text("utf-8-sig")
        tree = ast.parse(source)
        by_line = {
            token.start[0]: token.string.lstrip("# ")
            for token in tokenize.generate_tokens(io.StringIO(source).readline)
            if token.type == tokenize.COMMENT
        }
    except (OSError, ValueError, SyntaxError, tokenize.TokenError):
        return {}
    return {
        line.target.id: by_line.get(line.end_lineno or line.lineno, "")
        for node in tree.body
        if isinstance(node, ast.ClassDef) and node.name == "Params"
        for line in node.body
        if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name)
    }


def _in_comment(comment: str, k: int, size: int) -> str:
    """Return the unit in a comment: in brackets, as its first word or behind its last comma."""
    bracketed = [unit for unit in re.findall(r"\(([^()]*)\)", comment) if UNIT.fullmatch(unit)]
    if bracketed:
        return bracketed[k] if len(bracketed) == size else bracketed[0] if len(bracketed) == 1 else ""
    for part in (comment.split(";")[0].split(",")[0].strip(), comment.rsplit(",", 1)[-1].strip(), comment.strip()):
        if part in WORDS:
            return WORDS[part]
        if UNIT.fullmatch(part):
            return part
    first = re.match(r"\w+", comment)
    return WORDS.get(first[0], "") if first else ""


def _listed(comment: str, k: int, size: int) -> str:
    """Return the name of a tuple's number k if the comment lists the names; else ""."""
    words = [word.strip() for word in comment.split(",")]
    return words[k] if len(words) == size > 1 and all(re.fullmatch(r"[\w-]+", word) for word in words) else ""
