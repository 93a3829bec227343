"""Functions of time as other programs write them, ``2.0d*pi*time``, as those of Python: nothing else is understood."""

from __future__ import annotations

import ast
import math
import re
from dataclasses import dataclass

from shared.stage.errors import UserError

FUNCTIONS = {"sin": "sin", "cos": "cos", "exp": "exp", "sqrt": "sqrt"}
NUMBERS = {"pi": math.pi, "e": math.e}


@dataclass(frozen=True)
class Law:
    """A function of t; ``rate`` where it is a straight line."""

    text: str
    at_zero: float
    rate: float | None


def as_law(text: str, where: str) -> Law:
    """The law that an expression says. Raises UserError, with ``where``, for one that is not understood."""
    written = re.sub(r"(?<=\d)d\b", "", text.strip()).replace("^", "**")
    written = re.sub(r"(?<=[\d.])d(?=[-+]?\d)", "e", written)
    written = re.sub(r"\btime\b", "t", written)
    try:
        tree = ast.parse(written, mode="eval").body
        values = [_value(tree, time) for time in (0.0, 1.0, 0.5, 0.3, 2.7)]
    except (SyntaxError, ValueError, ArithmeticError, RecursionError) as error:
        raise UserError(f"{where}: the function of time {text.strip()[:80]!r} is not understood ({error})") from error
    rate = values[1] - values[0]
    lines = [values[0] + rate * time for time in (0.5, 0.3, 2.7)]
    straight = all(math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-12) for a, b in zip(values[2:], lines, strict=True))
    return Law(ast.unparse(tree), values[0], rate if straight else None)


def _value(node: ast.expr, time: float) -> float:
    match node:
        case ast.Constant(value=bool()):
            raise ValueError("a truth value")
        case ast.Constant(value=int() | float() as number):
            return float(number)
        case ast.Name(id="t"):
            return time
        case ast.Name(id=name) if name in NUMBERS:
            return NUMBERS[name]
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_value(inner, time)
        case ast.UnaryOp(op=ast.UAdd(), operand=inner):
            return _value(inner, time)
        case ast.BinOp(left=left, op=operator, right=right):
            return _combined(operator, _value(left, time), _value(right, time))
        case ast.Call(func=ast.Name(id=name), args=[inner], keywords=[]) if name in FUNCTIONS:
            return getattr(math, name)(_value(inner, time))
    raise ValueError(f"{ast.unparse(node)}")


def _combined(operator: ast.operator, a: float, b: float) -> float:
    match operator:
        case ast.Add():
            return a + b
        case ast.Sub():
            return a - b
        case ast.Mult():
            return a * b
        case ast.Div():
            return a / b
        case ast.Pow():
            power = a**b
            if isinstance(power, complex):
                raise ValueError("a root of a negative number")
            return power
    raise ValueError(type(operator).__name__)
