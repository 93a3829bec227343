"""A mechanism as a document of plain data (SI, radians), and back.

    {"schema": "mbsd.model", "schema_version": 1, "name": ..., "gravity": [gx, gy],
     "bodies": {"crank": {"mass", "com", "inertia", "length", "z", "products", "looks"}},
     "joints": {"A": {"kind", "i": {"body", "x", "y", "angle", "z"}, "j": ..., "params"}},
     "contacts": the same, "drivers": the same with "law", "forces": the same with "laws",
     "outlines": {"pawl": {"body", "corners", "hole"}}, "traces": {"P": marker},
     "starts": {"crank": {"angle", "place"}}, "velocities": {"crank": {"omega", "place"}}}

Kinds and laws are those of the registries: a joint or force is rebuilt by its kind's ``add``, from its
markers, its params and its laws, so a new kind needs no line here. Params that are
derived and not given are left out, such as static friction equal to that of sliding; com and inertia of a bar that is a
uniform rod are null. A model that does not come back equal cannot be saved. Errors name the file and the field.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, fields
from typing import Any, TypeVar

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.body import Body, Marker
from mbsd.model.change import given_body, law_name, with_markers
from mbsd.model.force import FORCE_KINDS, Force, ForceKind
from mbsd.model.joint import CONTACT_KINDS, KINDS, Joint, JointKind
from mbsd.model.mechanism import Model, Start, StartVelocity
from mbsd.model.outlines.outline import Outline, outline
from mbsd.saving.laws import called, law_from, plain

T = TypeVar("T")


class Entry:
    """An object of a JSON document and where it stands: ``my.json: joints.A``."""

    def __init__(self, data: Any, where: str) -> None:
        if not isinstance(data, Mapping):
            raise ModelError(f"{where} is {shown(data)}; it must be an object")
        self.data = data
        self.where = where

    def get(self, key: str) -> Any:
        """The value as it is, None if there is none."""
        return self.data.get(key)

    def number(self, key: str) -> float:
        """A finite number."""
        return _number(self._needed(key), f"{self.where}.{key}")

    def number_or_none(self, key: str) -> float | None:
        """A finite number, or null."""
        value = self._needed(key)
        return None if value is None else _number(value, f"{self.where}.{key}")

    def is_null(self, key: str) -> bool:
        """Return True if a field that must be there is null."""
        return self._needed(key) is None

    def numbers(self, key: str, count: int) -> tuple[Any, ...]:
        """A list of ``count`` finite numbers."""
        values = self._needed(key)
        if not isinstance(values, list) or len(values) != count:
            raise ModelError(f"{self.where}.{key} is {shown(values)}; it must be a list of {count} numbers")
        return tuple(_number(value, f"{self.where}.{key}[{k}]") for k, value in enumerate(values))

    def text(self, key: str) -> str:
        """A string."""
        value = self._needed(key)
        if not isinstance(value, str):
            raise ModelError(f"{self.where}.{key} is {shown(value)}; it must be a text")
        return value

    def entry(self, key: str) -> Entry:
        """An object within."""
        return Entry(self._needed(key), f"{self.where}.{key}")

    def entries(self, key: str) -> Iterator[tuple[str, Entry]]:
        """The named objects of a table such as ``bodies``."""
        table = self.entry(key)
        for name in table.data:
            yield name, table.entry(name)

    def within(self, read: Callable[[], T]) -> T:
        """Return what ``read`` returns; its ModelError gets the position in the file."""
        try:
            return read()
        except ModelError as error:
            raise ModelError(f"{self.where}: {error}") from error

    def check_fields(self, *known: str) -> None:
        """Raise ModelError for a field that is not one of ``known``."""
        others = [key for key in self.data if key not in known]
        if others:
            raise ModelError(f"{self.where}: {no_such('field', others[0], known)}")

    def _needed(self, key: str) -> Any:
        if key not in self.data:
            raise ModelError(f"{self.where}: the field '{key}' is missing")
        return self.data[key]


def _number(value: Any, where: str) -> float:
    return finite_number(where, value)


K = TypeVar("K")
M = TypeVar("M", bound=Model)

SCHEMA, SCHEMA_VERSION = "mbsd.model", 1


def document(m: Model) -> dict[str, Any]:
    """The mechanism as JSON types. Raises ModelError naming what a file cannot hold."""
    written = _write(m)
    if _write(build(written, type(m))) != written:
        raise ModelError(f"{m.name}: the model does not come back from a file as it is; build it in Python instead")
    return written


def build(written: Mapping[str, Any], make: type[M], where: str = "model") -> M:
    """Return a document's mechanism. Raises ModelError naming the field and the remedy.

    ``where`` is the file.
    """
    top = Entry(written, where)
    _check_version(top)
    m = top.within(lambda: make(top.text("name"), top.numbers("gravity", 2)))
    for name, entry in top.entries("bodies"):
        _read_body(m, name, entry)
    for part in ("joints", "drivers"):
        for name, entry in top.entries(part):
            _read_joint(m, part, name, entry)
    for name, entry in top.entries("forces"):
        _read_force(m, name, entry)
    for name, entry in top.entries("contacts"):
        _read_contact(m, name, entry)
    for name, entry in top.entries("outlines") if top.get("outlines") else ():
        _read_outline(m, name, entry)
    for name, entry in top.entries("traces"):
        entry.within(lambda name=name, entry=entry: m.trace(name, _read_marker(m, entry)))
    for name, entry in top.entries("starts"):
        m.starts[name] = Start(*_read_state(m, name, entry, "angle"))
    for name, entry in top.entries("velocities"):
        m.velocities[name] = StartVelocity(*_read_state(m, name, entry, "omega"))
    top.check_fields("schema", "schema_version", *(field.name for field in fields(make)))
    return m


# -- writing ----------------------------------------------------------------------------------------------------


def _write(m: Model) -> dict[str, Any]:
    parts = {
        "name": m.name,
        "gravity": list(m.gravity or ()),
        "bodies": {name: _body(body) for name, body in m.bodies.items() if name != "ground"},
        "joints": {name: _joint(m, joint) for name, joint in m.joints.items()},
        "drivers": {name: _joint(m, driver) for name, driver in m.drivers.items()},
        "forces": {name: _force(m, force) for name, force in m.forces.items()},
        "contacts": {name: _joint(m, contact, "contact") for name, contact in m.contacts.items()},
        "outlines": {name: _outline(outline) for name, outline in m.outlines.items()},
        "traces": {name: plain(marker, name) for name, marker in m.traces.items()},
        "starts": {name: _state(start) for name, start in m.starts.items()},
        "velocities": {name: _state(velocity) for name, velocity in m.velocities.items()},
    }
    if not m.outlines:
        del parts["outlines"]
    missing = [field.name for field in fields(m) if field.name not in parts and getattr(m, field.name)]
    if missing:
        raise ModelError(f"{m.name}: {', '.join(missing)} of the model cannot be saved; build it in Python instead")
    return {"schema": SCHEMA, "schema_version": SCHEMA_VERSION} | parts


def _body(body: Body) -> dict[str, Any]:
    own = given_body(body)
    com = list(own["com"]) if "com" in own else None
    out = {"mass": own["mass"], "com": com, "inertia": own.get("inertia"), "length": body.length}
    if body.z is not None:
        out["z"] = body.z
    if any(body.products):
        out["products"] = list(body.products)
    if body.looks:
        out["looks"] = body.looks
    return out


def _joint(m: Model, joint: Joint, part: str = "joint") -> dict[str, Any]:
    what = f"{m.name}: {'driver' if joint.kind.driven else part} '{joint.name}'"
    out = {"kind": joint.kind.name, "i": plain(joint.i, what), "j": plain(joint.j, what)}
    out["params"] = {key: plain(value, f"{what}: {key}") for key, value in joint.given.items()}
    if joint.motion is not None:
        out["law"] = plain(joint.motion, f"{what}: its law")
    return out


def _force(m: Model, force: Force) -> dict[str, Any]:
    what = f"{m.name}: force '{force.name}'"
    out = {"kind": force.kind.name, "i": plain(force.i, what), "j": plain(force.j, what)}
    out["params"] = {key: plain(value, f"{what}: {key}") for key, value in force.given.items()}
    return out | {"laws": {key: plain(law, f"{what}: {key}") for key, law in force.laws.items()}}


def _outline(outline: Outline) -> dict[str, Any]:
    corners = [list(corner) for corner in outline.corners]
    return {"body": outline.body.name, "corners": corners, "hole": outline.is_hole}


def _state(state: Any) -> dict[str, Any]:
    return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(state).items()}


# -- reading ----------------------------------------------------------------------------------------------------


def _check_version(top: Entry) -> None:
    for key, wanted in (("schema", SCHEMA), ("schema_version", SCHEMA_VERSION)):
        given = top.get(key)
        if given != wanted or isinstance(given, bool):
            said = "missing" if given is None else shown(given)
            raise ModelError(
                f"{top.where}: {key} is {said}, this program reads {wanted!r}; save the model again with this version"
            )


def _read_body(m: Model, name: str, entry: Entry) -> None:
    bar = entry.get("length") is not None
    mass = entry.number_or_none("mass")
    inertia = None if bar and entry.is_null("inertia") else entry.number("inertia")
    com = None if bar and entry.is_null("com") else entry.numbers("com", 2)
    z = None if entry.get("z") is None else entry.number("z")
    products = (0.0, 0.0) if entry.get("products") is None else entry.numbers("products", 2)
    looks = "" if entry.get("looks") is None else entry.text("looks")
    entry.check_fields("mass", "com", "inertia", "length", "z", "products", "looks")
    if bar:
        length = entry.number("length")
        entry.within(lambda: m.bar(name, length, mass, com, inertia, z=z, products=products, looks=looks))
    else:
        assert com is not None
        assert inertia is not None
        entry.within(lambda: m.body(name, mass, com, inertia, z=z, products=products, looks=looks))


def _read_marker(m: Model, entry: Entry) -> Marker:
    body = entry.within(lambda: m.known_body(entry.text("body")))
    entry.check_fields("body", "x", "y", "angle", "z")
    z = None if entry.get("z") is None else entry.number("z")
    return body.at(entry.number("x"), entry.number("y"), entry.number("angle"), z)


def _read_state(m: Model, name: str, entry: Entry, turn: str) -> tuple[float, tuple[float, float] | None]:
    """A start pose or velocity: about the angle, and of the body's frame if given."""
    entry.within(lambda: m.known_body(name))
    entry.check_fields(turn, "place")
    return entry.number(turn), entry.numbers("place", 2) if entry.get("place") is not None else None


def _read_joint(m: Model, part: str, name: str, entry: Entry) -> None:
    kind = _kind(entry, part[:-1], {key: kind for key, kind in KINDS.items() if kind.driven == (part == "drivers")})
    entry.check_fields("kind", "i", "j", "params", *(["law"] if kind.driven else []))
    add = _adds(kind)
    named = _params(m, entry)
    if kind.driven:
        named[law_name(add)] = law_from(entry.entry("law").data, entry.where)
    _add(m, add, name, entry, named)


def _read_force(m: Model, name: str, entry: Entry) -> None:
    kind = _kind(entry, "force", FORCE_KINDS)
    entry.check_fields("kind", "i", "j", "params", "laws")
    laws = {key: law_from(law.data, law.where) for key, law in entry.entries("laws")}
    _add(m, _adds(kind), name, entry, _params(m, entry) | laws)


def _read_contact(m: Model, name: str, entry: Entry) -> None:
    kind = _kind(entry, "contact", CONTACT_KINDS)
    entry.check_fields("kind", "i", "j", "params")
    _add(m, _adds(kind), name, entry, _params(m, entry))


def _read_outline(m: Model, name: str, entry: Entry) -> None:
    entry.check_fields("body", "corners", "hole")
    body = entry.within(lambda: m.known_body(entry.text("body")))
    entry.within(lambda: outline(m, body, entry.get("corners"), name, hole=entry.get("hole") is True))


def _adds(kind: JointKind | ForceKind) -> Callable[..., Any]:
    """The function that adds one of a kind."""
    assert kind.add is not None
    return kind.add


def _kind(entry: Entry, what: str, kinds: Mapping[str, K]) -> K:
    kind = kinds.get(entry.text("kind"))
    if kind is None:
        raise ModelError(f"{entry.where}: {no_such(f'{what} of kind', entry.text('kind'), kinds)}")
    return kind


def _params(m: Model, entry: Entry) -> dict[str, Any]:
    return {key: _value(m, value, entry) for key, value in entry.entry("params").data.items()}


def _value(m: Model, value: Any, entry: Entry) -> Any:
    """A parameter: numbers as they are, a law, a body or a marker from its object."""
    if isinstance(value, dict) and "law" in value:
        return law_from(value, entry.where)
    if isinstance(value, dict) and set(value) == {"body"}:
        return entry.within(lambda: m.known_body(value["body"]))
    if isinstance(value, dict) and {"body", "x", "y", "angle"} <= set(value):
        return _read_marker(m, Entry(value, f"{entry.where}.params"))
    return value


def _add(m: Model, add: Callable[..., Any], name: str, entry: Entry, named: dict[str, Any]) -> None:
    """Call the function that adds a joint, driver, force or contact."""
    markers = [_read_marker(m, entry.entry(key)) for key in ("i", "j")]
    in_order, named = entry.within(lambda: with_markers(add, markers, named, m.bodies))
    called(add, entry.where, [m, name, *in_order], named)
