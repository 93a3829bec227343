"""What the CAD kernel cannot do, and shapes that are tried one after the other until it can."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import cadquery as cq


def is_of_kernel(error: BaseException) -> bool:
    """Whether the CAD kernel raised this; it has hundreds of exceptions without a common base."""
    return type(error).__module__.split(".")[0] == "OCP"


def first_sound(ways: Sequence[Callable[[], cq.Workplane]]) -> cq.Workplane | None:
    """The first shape that has room and that the CAD kernel can make; None if there is none."""
    for way in ways:
        try:
            shape = way()
            if shape.val().isValid():
                return shape
        except Exception as error:
            if not isinstance(error, ValueError) and not is_of_kernel(error):
                raise
    return None
