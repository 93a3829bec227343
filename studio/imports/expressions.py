"""Functions of time of other programs, ``2.0d*pi*time``, translated into Python.

Nothing else is accepted.
"""

from __future__ import annotations

import ast
import math
import re
from dataclasses import dataclass

from shared.stage.errors import UserError

FUNCTIONS = {"sin": math.sin, "cos": math.cos, "exp": math.exp, "sqrt": math.sqrt}
NUMBERS = {"pi": math.pi, "e": math.e}
LONGEST = 1000
"""Characters"""


@dataclass(frozen=True)
class Law:
    """Function of t, with its ``rate`` if it is a straight line."""

    text: str
    at_zero: float
    rate: float | None

    def from_zero(self, sign: float) -> str:
        """Return it less its value at t = 0, with the other sign if ``sign`` is negative."""
        tree = ast.parse(self.text, mode="eval").body
        if self.at_zero:
            tree = ast.BinOp(tree, ast.Sub(), ast.Constant(self.at_zero))
        return ast.unparse(ast.UnaryOp(ast.USub(), tree) if sign < 0.0 else tree)


def as_law(text: str, where: str) -> Law:
    """Return the law that an expression gives. Raises UserError, with ``where``, if it is not understood.

    It is a straight line where its terms are: sums of numbers and of multiples of time. Samples could not tell, as
    sin(10 pi t) is zero at each tenth of a second.
    """
    written = re.sub(r"(?<=\d)d\b", "", text.strip()).replace("^", "**")
    written = re.sub(r"(?<=[\d.])d(?=[-+]?\d)", "e", written)
    written = re.sub(r"\btime\b", "t", written)
    try:
        if len(written) > LONGEST:
            raise ValueError(f"{len(written)} characters, more than {LONGEST}")
        tree = ast.parse(written, mode="eval").body
        at_zero, line = _value(tree, 0.0), _line(tree)
        if not all(math.isfinite(number) for number in (at_zero, *(line or ()))):
            raise ValueError("a number in it is not finite")
    except (SyntaxError, ValueError, ArithmeticError, RecursionError, MemoryError) as error:
        raise UserError(f"{where}: the function of time {text.strip()[:80]!r} is not understood ({error})") from error
    return Law(ast.unparse(tree), at_zero, line[1] if line else None)


def _line(node: ast.expr) -> tuple[float, float] | None:
    """Return a, b if an expression has the form a + b t; None if it has not."""
    match node:
        case ast.Name(id="t"):
            return 0.0, 1.0
        case ast.UnaryOp(op=operator, operand=inner):
            line = _line(inner)
            sign = -1.0 if isinstance(operator, ast.USub) else 1.0
            return line and (sign * line[0], sign * line[1])
        case ast.BinOp(left=left, op=operator, right=right):
            a, b = _line(left), _line(right)
            return a and b and _combined_lines(operator, a, b)
        case ast.Call(args=[inner]):
            line = _line(inner)
            return (_value(node, 0.0), 0.0) if line and line[1] == 0.0 else None
    return _value(node, 0.0), 0.0


def _combined_lines(
    operator: ast.operator, a: tuple[float, float], b: tuple[float, float]
) -> tuple[float, float] | None:
    match operator:
        case ast.Add():
            return a[0] + b[0], a[1] + b[1]
        case ast.Sub():
            return a[0] - b[0], a[1] - b[1]
        case ast.Mult() if a[1] == 0.0 or b[1] == 0.0:
            return a[0] * b[0], a[0] * b[1] + a[1] * b[0]
        case ast.Div() if b[1] == 0.0:
            return a[0] / b[0], a[1] / b[0]
        case ast.Pow() if a[1] == b[1] == 0.0:
            return _combined(operator, a[0], b[0]), 0.0
        case ast.Pow() if b == (1.0, 0.0):
            return a
    return None


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
            return FUNCTIONS[name](_value(inner, time))
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
