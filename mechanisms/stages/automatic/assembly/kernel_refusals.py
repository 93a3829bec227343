"""What the CAD kernel cannot make of automatic parts is a refusal that names it, no traceback."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from shared.shapes.kernel import is_of_kernel
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

KERNEL = "the CAD kernel cannot make"
"""Words of such a refusal."""


@contextmanager
def kernel_refusals(name: str, what: str) -> Iterator[None]:
    """Raise UserError that names mechanism ``name`` and ``what`` where the CAD kernel fails, or a shape has no room."""
    try:
        yield
    except Exception as error:
        if not isinstance(error, ValueError) and not is_of_kernel(error):
            raise
        raise UserError(
            f"{name}: {KERNEL} {what} ({type(error).__name__}: {error}); change its sizes a little, make pins thinner "
            f"(automatic(m, pin=...)), or shape it by hand in {shown_file(name, 'parts')}"
        ) from error
