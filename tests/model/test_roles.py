"""Roles of arguments in change(), files and the schema come from their types, however written."""

from typing import Optional

import pytest

import mbsd.extend as extend
from mbsd import Body, Curve, Mechanism
from mbsd import Marker as Place
from mbsd.base.arguments import types_of
from mbsd.extend import Amount, ForceKind, Law, Model, add_force
from mbsd.model.change import Role, arguments
from mbsd.model.force import FORCE_KINDS
from mbsd.saving.document import build, document


def other_words(
    model: extend.Model,
    name: str,
    i: Place,
    j: "extend.Marker",
    size: Optional[float],  # noqa: UP045
    against: Body | None = None,
    law: Law = lambda t: t,
    amount: Amount = 1.0,
    profile: Curve | None = None,
    *,
    unknown: "Nowhere" = None,  # noqa: F821  # pyright: ignore[reportUndefinedVariable]
):
    """Written without postponed annotations, with other names and in part as text."""


def test_arguments_are_told_by_their_types() -> None:
    roles = {argument.name: argument.role for argument in arguments(other_words)}
    assert roles == {
        "i": Role.MARKER, "j": Role.MARKER, "size": Role.VALUE, "against": Role.OPTIONAL_BODY, "law": Role.LAW,
        "amount": Role.AMOUNT, "profile": Role.CURVE, "unknown": Role.VALUE,
    }  # fmt: skip
    assert types_of(other_words)["size"] == (float, type(None))
    assert types_of(other_words)["unknown"] == ("Nowhere",)
    assert [argument.name for argument in arguments(other_words) if argument.needed] == ["i", "j", "size"]


def test_a_kind_under_other_names_is_changed_saved_and_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its annotations are not the words ``Marker`` and ``Body | None``."""
    kind = ForceKind("pull", example=lambda m, i, j: None)
    monkeypatch.setitem(FORCE_KINDS, "pull", kind)

    @kind.adds
    def pull(m: Model, name: str, i: Place, j: Place, size: Optional[float] = None):  # noqa: UP045
        return add_force(m, kind, name, i, j, {"size": size})

    m = Mechanism("m")
    body = m.body("body", 1.0, inertia=1.0)
    pull(m, "pull", m.ground.at(0.1, 0.2), body.at(0.3, 0.4, 0.5), 2.0)
    m.change("pull", size=3.0)
    back = build(document(m), Mechanism).forces["pull"]
    assert back.params == {"size": 3.0}
    assert (back.i.x, back.i.y, back.j.x, back.j.angle) == (0.1, 0.2, 0.3, 0.5)


def test_a_solution_knows_the_class_that_was_solved() -> None:
    class Own(Mechanism):
        """A mechanism of one's own."""

    m = Own("own")
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.drive_angle("motor", rod, lambda t: t)
    assert isinstance(m.sweep(1.0, steps=2).mechanism, Own)
