"""Automatic parts: from the model and its motion to solids, without a parts.py.

In this order, a chapter each:

    layout/sizes.py   one scale from the links; all is laid out in reference millimetres (rmm), pins 8 rmm thick
    layout/motion.py  poses of all bodies over the motion
    kinds.py          the families of joints, forces and contacts that have parts (pins, slides, cams, rolling, wheels)
    features.py       each joint becomes a feature: places that bodies must reach, room that it takes, heights of gaps
    layout/layout.py  outlines of bodies round the features' places; which items meet in the plane (planar.py)
    layout/layers.py  the search for an order of layers
    decision.py       thickness of pins, layers, bridges (pins/bridges.py); or the reason why there is no order
    layout/items.py   layers become heights
    layout/plan.py    features give bodies their eyes, and add hardware
    assembly.py       plates (body_shapes.py), base (standing.py) and hardware become solids, in millimetres
    automatic.py      the face

Where bodies have places z along the normal, shafts/ plans and builds all of this instead (its docstring says how).

To add a kind of joint, write a module with a class that has the three methods of :class:`layout.Feature`
(``pins/pins.py`` is the pattern), a function ``gather(m, joints, layout) -> list[Feature]`` under ``@kind("name of the
joint's kind")``, and a line in ``kinds.py``; ``@force_kind`` and ``@contact_kind`` do the same for forces and
contacts. ``anchors`` returns the places that outlines of bodies must reach. ``items`` returns what takes room besides
plates: a convex shape with round corners that moves with one body, and a :class:`items.Reach`, which gives its heights
from the layers of bodies. ``needs`` asks for gaps between layers once these are known. A function under
``@build.register(Pin)`` gives eyes to plates and adds solids to the plan; where these are few lines, a method ``build``
of the class does. The search for layers knows nothing of kinds: it sees items alone. Solids that are general belong to
shared/shapes.
"""
