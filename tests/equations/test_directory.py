"""The directory says where packing has put the numbers of each force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mbsd import harmonic
from mbsd.arrays.directory import directory, numbers_of, slice_of
from mbsd.arrays.laws import compiled_laws, law_values
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.mechanism import Mechanism
from mbsd.model.force import FORCE_KINDS
from mbsd.model.laws import Motion


def _mixed(seed: int) -> Mechanism:
    """Return forces of all kinds in random order between random bodies, some kinds twice, none by its kind's name."""
    random = np.random.default_rng(seed)
    m = Mechanism("mixed")
    bodies = [m.ground, *(m.body(f"body {k}", 1.0, random.normal(size=2).tolist(), 1.0) for k in range(5))]
    kinds = [*FORCE_KINDS.values(), *random.choice(list(FORCE_KINDS.values()), 6)]
    for k in random.permutation(len(kinds)).tolist():
        kind, (a, b) = kinds[k], random.choice(6, 2, replace=False)
        assert kind.example is not None
        if (kind.of_reactions or kind.valved) and any(force.kind is kind for force in m.forces.values()):
            continue  # its example adds a joint of one name
        kind.example(m, bodies[a].at(*random.normal(size=3)), bodies[b].at(*random.normal(size=3)))
        force = m.forces.pop("example")
        m.forces[f"{k}"] = replace(force, name=f"{k}")
    return m


def _own(packed: Packed, name: str) -> list[float]:
    loads = pack_loads(packed)
    return [float(array[index]) for array, index in directory(packed)[name].entries(loads)]


@pytest.mark.parametrize("seed", range(4))
def test_numbers_stand_where_it_says(seed: int) -> None:
    packed = pack(_mixed(seed))
    for force in packed.forces:
        own = _own(packed, force.name)
        given = numbers_of(force, packed.masses)
        assert own == pytest.approx(given, abs=0.0, rel=0.0, nan_ok=True), force.name


@pytest.mark.parametrize("seed", range(4))
def test_loads_of_one_force_are_those_that_are_packed_without_others(seed: int) -> None:
    packed = pack(_mixed(seed))
    loads, rows = pack_loads(packed), directory(packed)
    assert list(rows) == [force.name for force in packed.forces]
    for k, force in enumerate(packed.forces):
        lone = replace(packed, forces=[force], force_markers=packed.force_markers[k : k + 1])
        alone = pack_loads(lone)
        part = rows[force.name].alone(loads)
        assert part.total == alone.total
        for name in ("place", "friction", "friction_number"):
            assert getattr(part, name).tobytes() == getattr(alone, name).tobytes(), (force.name, name)
        for name, columns in (("element", [0, 1, 2]), ("interaction", [0, 1, 4, 5, 6, 7, 8]), ("user", [0, 2])):
            assert (getattr(part, name)[:, columns] == getattr(alone, name)[:, columns]).all(), (force.name, name)
        for table, row in zip(alone.element, part.element, strict=True):
            assert loads.number[row[3] : row[4]].tobytes() == alone.number[table[3] : table[4]].tobytes()
        for block, own in zip(directory(lone)[force.name].blocks, rows[force.name].blocks, strict=True):
            assert loads.given[slice_of(own)].tobytes() == alone.given[slice_of(block)].tobytes(), force.name


def test_no_row_is_of_two_forces_or_of_none() -> None:
    packed = pack(_mixed(7))
    loads, rows = pack_loads(packed), list(directory(packed).values())
    tables = {"element": loads.element, "term": loads.term, "interaction": loads.interaction, "user": loads.user,
              "user_body": loads.user_body, "friction": loads.friction}  # fmt: skip
    for name, table in tables.items():
        assert [row for own in rows for row in getattr(own, name)] == list(range(len(table))), name
    assert [place for own in rows for block in own.blocks for place in block] == list(range(len(loads.given)))


def test_forces_in_another_order_keep_their_numbers() -> None:
    m = _mixed(3)
    before = {name: _own(pack(m), name) for name in m.forces}
    turned = dict(reversed(m.forces.items()))
    m.forces.clear()
    m.forces.update(turned)
    for name, numbers in before.items():
        assert _own(pack(m), name) == pytest.approx(numbers, abs=0.0, rel=0.0, nan_ok=True), name


def test_forces_that_share_a_law_have_rows_of_their_own() -> None:
    m = Mechanism("shared")
    bar = m.bar("bar", 0.3, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), bar.start)
    law = harmonic(2.0, 3.0)
    for name in ("first", "second"):
        m.torque(name, bar, law)
    m.torque("other", bar, harmonic(5.0, 1.0))
    packed = pack(m)
    laws = compiled_laws(packed, 0.0, 1.0)
    rows = directory(packed)
    assert [own.law for own in rows.values()] == [range(1, 2), range(2, 3), range(3, 4)]
    times = np.linspace(0.0, 1.0, 5)
    for force in packed.forces:
        [values] = law_values(packed, laws, force, times).values()
        [given] = force.laws.values()
        assert isinstance(given, Motion)
        np.testing.assert_allclose(values, given(times)[:, 0], rtol=1e-12, atol=1e-12)
