"""Hash of the meaning of Python source: its syntax tree without positions and docstrings.

Comments, blank lines, line breaks and quotation marks do not count; every number, text, operator and name does. Where
source looks at itself (``__doc__``, inspect, line numbers), everything counts: :func:`looks_at_itself`.
"""

from __future__ import annotations

import ast
import hashlib
from functools import lru_cache
from typing import Any

DYNAMIC = ("import_module", "__import__", "sys.modules", "runpy", "exec(", "eval(")
"""Words of source that may load modules unseen by its import statements."""
REFLECTIVE = (
    *("__doc__", "getdoc", "getcomments", "getsource", "findsource", "linecache", "tokenize", "lineno", "_getframe"),
    *("currentframe", "inspect.stack", "inspect.trace", "traceback", "doctest", "ast.parse"),
)
"""Words of source that may depend on docstrings, on the text of source, or on places in it."""
_DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


@lru_cache(maxsize=8192)
def meaning(source: bytes) -> str:
    """SHA-256 of what the source means; of its bytes where it is no Python."""
    try:
        tree = parsed(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return hashlib.sha256(b"no python\0" + source).hexdigest()
    return hashlib.sha256(repr(_flat(tree)).encode(errors="surrogatepass")).hexdigest()


@lru_cache(maxsize=4)
def parsed(source: bytes) -> ast.Module:
    """The syntax tree, which whoever looks at a file next needs as well. Raises what ``ast.parse`` does."""
    return ast.parse(source)


def looks_at_itself(source: bytes) -> bool:
    """True if code may depend on docstrings, comments or lines, its own or those of modules that it knows."""
    return any(word.encode() in source for word in REFLECTIVE)


def _flat(tree: ast.AST) -> list[Any]:
    """Kinds of nodes and values of the tree, in an order and with counts that leave only one tree."""
    out: list[Any] = []
    waiting: list[Any] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.AST):
            out.append(type(node).__name__)
            fields = [getattr(node, name, None) for name in node._fields if name != "type_comment"]
            if isinstance(node, _DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
                fields[fields.index(node.body)] = node.body[1:]
            if isinstance(node, ast.Constant):
                fields = [node.value]
            waiting.extend(fields)
        elif isinstance(node, list):
            out.append(len(node))
            waiting.extend(node)
        else:
            out += (type(node).__name__, node)
    return out
