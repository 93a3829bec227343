"""Numbers in the source of a mechanism.py: only the literal of each is replaced.

A default of Params is a number, or a tuple of numbers at whose place it stands; ``field(default=...)`` is one, too. A
default that is computed (``2 * pi``) is replaced as a whole. Of a variant, the numbers are those of VARIANTS.
"""

from __future__ import annotations

import ast
import re
import tokenize
from io import BytesIO

from shared.stage.errors import UserError
from studio.live.numbers import parsed

LINES = re.compile(r"[^\r\n]*(?:\r\n|\r|\n)?")


def replaced(source: bytes, file: str, values: dict[str, float | int], variant: str | None = None) -> bytes:
    """Return the source with other numbers. Raises UserError; ``file`` is its name in errors."""
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError) as error:
        raise UserError(f"{file}: {error}; cure it first, then numbers can be written into it") from error
    encoding, _ = tokenize.detect_encoding(BytesIO(source.replace(b"\r", b"\n")).readline)
    text = source.decode(encoding)
    starts = _line_starts(text)
    lines = [text[a:b] for a, b in zip(starts, [*starts[1:], len(text)], strict=True)]

    def place(line: int, column: int) -> int:
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    edits = []
    for name, value in values.items():
        node = literal(tree, name, file, variant)
        end = place(node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)
        edits.append((place(node.lineno, node.col_offset), end, repr(value)))
    for first, last, new in sorted(edits, reverse=True):
        text = text[:first] + new + text[last:]
    ast.parse(text)
    return text.encode(encoding)


def _line_starts(text: str) -> list[int]:
    """Return the beginning of each line, as Python counts lines."""
    return [match.start() for match in LINES.finditer(text) if match[0]] or [0]


def literal(tree: ast.Module, name: str, file: str, variant: str | None) -> ast.expr:
    """Return the place of a number in the file. Raises UserError if it has none of its own."""
    field, places = parsed(name)
    node = _of_variant(tree, field, file, variant) if variant else _of_params(tree, field, file)
    for place in places:
        if not isinstance(node, ast.Tuple | ast.List) or place >= len(node.elts):
            raise UserError(
                f"{file}:{node.lineno}: {field} is computed, so {name} has no number of its own there; write its "
                "numbers out, as in (0.06, 0.03)"
            )
        node = node.elts[place]
    if isinstance(node, ast.Starred):
        raise UserError(f"{file}:{node.lineno}: {name} is one of *{ast.unparse(node.value)}; write its number out")
    return node


def _of_params(tree: ast.Module, field: str, file: str) -> ast.expr:
    for statement in tree.body:
        if isinstance(statement, ast.ClassDef) and statement.name == "Params":
            for line in statement.body:
                if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name) and line.target.id == field:
                    default = _default(line.value)
                    if default is not None:
                        return default
                    raise UserError(f"{file}:{line.lineno}: Params.{field} has no default of its own to replace")
    raise UserError(f"{file}: class Params does not define '{field}' itself; write its default there")


def _default(value: ast.expr | None) -> ast.expr | None:
    """Return the default, also of field(default=...)."""
    if isinstance(value, ast.Call) and isinstance(value.func, ast.Name | ast.Attribute):
        called = value.func.id if isinstance(value.func, ast.Name) else value.func.attr
        if called == "field":
            return next((keyword.value for keyword in value.keywords if keyword.arg == "default"), None)
    return value


def _of_variant(tree: ast.Module, field: str, file: str, variant: str) -> ast.expr:
    for statement in tree.body:
        targets = getattr(statement, "targets", [getattr(statement, "target", None)])
        value = getattr(statement, "value", None)
        if not any(isinstance(t, ast.Name) and t.id == "VARIANTS" for t in targets) or not isinstance(value, ast.Dict):
            continue
        inner = _of_key(value, variant)
        given = _of_key(inner, field) if isinstance(inner, ast.Dict) else None
        if given is not None:
            return given
    raise UserError(
        f"{file}: VARIANTS['{variant}'] does not replace '{field}', so writing it would change the mechanism itself; "
        f'add "{field}" there first, or open the mechanism'
    )


def _of_key(node: ast.Dict, wanted: str) -> ast.expr | None:
    pairs = zip(node.keys, node.values, strict=True)
    return next((value for key, value in pairs if isinstance(key, ast.Constant) and key.value == wanted), None)
