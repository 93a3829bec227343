"""Built-up cranks: a body of two plates, its webs, that the pin between them joins; a link turns on the pin.

So a link passes a pivot of its own crank that no bar lets it pass, as on a crankshaft. All of a body that is no pin
stays on the first web; pins are shared out.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.pins.pins import Pin

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.layout import Layout


def webbed(layout: Layout, bodies: Collection[str]) -> Iterable[Layout]:
    """Layouts in which one of ``bodies`` has a further web: each of its pins once as the one that joins both, and the
    others shared out in every way.
    """
    for body in (body for body in bodies if body in layout.bodies):
        pins = [pin for pin in layout.features if isinstance(pin, Pin) and body in pin.places]
        pins.sort(key=lambda pin: not pin.on_ground)
        free = [pin for pin in pins if not layout.is_held(pin)]
        for joining in free:
            if joining.on_ground or len(joining.places) < 2:
                continue
            rest = [pin for pin in pins if pin is not joining]
            more = any(a.body == body for f in layout.features if f not in pins for a in f.anchors(layout))
            moved = [pin for pin in (rest if more else rest[1:]) if pin in free]
            for count in range(1, len(moved) + 1):
                for chosen in combinations(moved, count):
                    yield _with_web(layout, body, joining, chosen)


def _with_web(layout: Layout, body: str, joining: Pin, chosen: Collection[Pin]) -> Layout:
    web = f"{body} 2"
    while web in layout.poses:
        web += "2"
    features = []
    for feature in layout.features:
        if feature is joining:
            places = {**joining.places, web: joining.places[body]}
            feature = replace(joining, places=places, webs=(body, web))
        elif isinstance(feature, Pin) and feature in chosen:
            feature = replace(feature, places={web if b == body else b: at for b, at in feature.places.items()})
        features.append(feature)
    poses = {**layout.poses, web: layout.poses[body]}
    return replace(layout, features=features, poses=poses, webs={**layout.webs, web: body})
