"""How joints, forces and contacts look beyond their signs: markers, wheels, curves, as data.json has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from shared.contract import Shape

if TYPE_CHECKING:
    from mbsd import Joint
    from mbsd.model.force import Force

POINTS = 240
"""Points of an outline, about and at most."""


def shape_of(element: Joint | Force) -> Shape:
    """The shape between the two markers of a joint, force or contact."""
    from mbsd.model.force import Force as AnyForce
    from mbsd.model.force import ForceKind
    from mbsd.model.teeth import with_radii

    params = dict(with_radii(element.params))
    profile, laws = params.get("profile"), getattr(element, "laws", {})
    outline: list[tuple[float, float]] = []
    if profile is not None:
        outline, sizes = _cam(profile)
        params |= sizes
    elif "points" in params:
        outline = _curve(params["points"], params["closed"])
    elif "profile" in laws:
        outline = _profile(laws["profile"])
    if isinstance(element, AnyForce) and element.kind.journal is not None:  # the bearing lies around the journal
        params |= {"radius_i": params["radius"], "radius_j": element.kind.journal(element)[0], "inside": True}
    geneva = "slots" in params
    teeth = params.get("teeth")
    of_pin = isinstance(element.kind, ForceKind) and element.kind.of_reactions
    return Shape(
        bodies=element.bodies,
        markers=((element.i.x, element.i.y, element.i.angle), (element.j.x, element.j.y, element.j.angle)),
        radius_first=_positive(params.get("radius_i")),
        radius_second=None if geneva or of_pin else _positive(params.get("radius_j", params.get("radius"))),
        teeth=[] if teeth is None else [teeth] if isinstance(teeth, int) else list(teeth),
        ring=bool(params.get("internal") or params.get("inside")),
        crossed=bool(params.get("crossed")),
        slots=params.get("slots"),
        pin_radius=_positive(params.get("radius")) if geneva or of_pin else None,
        length=None if of_pin else params.get("length", params.get("free_length")),
        outline=outline,
        outline_closed=profile is not None or bool(params.get("closed")),
    )


def _positive(value: float | None) -> float | None:
    return value if value else None


def _cam(data: Any) -> tuple[list[tuple[float, float]], dict[str, float]]:
    """The disc as it is cut, and the radius of its roller if it has one."""
    from mbsd.cams import cam_from

    profile = cam_from(data)
    kept = profile.outline[:: max(1, len(profile.outline) // POINTS)]
    return _pairs(kept), {} if profile.flat else {"radius": profile.sizes["roller_radius"]}


def _curve(points: Any, closed: bool) -> list[tuple[float, float]]:
    """The smooth curve through the points of a joint or terrain."""
    import numpy as np

    from mbsd.model.plane_curves import curve_pieces

    breaks, coefficients = curve_pieces(np.array(points, float), closed)  # (pieces, 2, 6) by rising powers
    each = max(1, round(POINTS / len(coefficients)))
    width = np.diff(breaks)
    ahead = width[:, None] * np.arange(each) / each
    path = np.einsum("spk,sck->spc", ahead[..., None] ** np.arange(6), coefficients).reshape(-1, 2)
    end = np.einsum("k,ck->c", width[-1] ** np.arange(6), coefficients[-1])
    return _pairs(path if closed else np.vstack([path, end]))


def _profile(curve: Any) -> list[tuple[float, float]]:
    """The profile y(x) of a surface with give."""
    import numpy as np

    x = np.linspace(float(curve.x[0]), float(curve.x[-1]), POINTS + 1)
    return _pairs(np.stack([x, curve(x)[:, 0]], axis=1))


def _pairs(path: Any) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in path]
