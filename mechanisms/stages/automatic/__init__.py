"""Automatic parts: from the model and its motion to solids, without a parts.py.

In this order, a file each:

    layout/sizes.py     one scale from the links; all is laid out in reference millimetres (rmm), pins 8 rmm thick
    layout/motion.py    poses of all bodies over the motion
    kinds.py            each joint becomes a feature: places that bodies must reach, what takes room, heights of gaps
    pins/free/points.py traced points, free ends, lone centres of mass: features without a joint
    layout/layout.py    outlines of bodies round the features' places; which items meet in the plane (planar.py)
    layout/order/       the search for an order of layers (layer_clauses.py its rules; refusal.py why there is none)
    decided.py          which thickness of pins, which layers; pivots that must hang get bridges (pins/bridges.py)
    layout/order/       layers become heights (heights.py)
    layout/plan.py      features give bodies their eyes, and add hardware
    assembly/built.py   plates (body_shape.py, marks.py), base (frame.py) and hardware become solids, in millimetres
    automatic.py        the face

Where bodies have places z along the normal, shafts/ plans and builds all of this instead (its docstring says how).

How a kind of joint is added: a module with a class that has the three methods of :class:`layout.Feature`
(``pins/pins.py`` is the pattern), a function ``gather(m, joints, layout) -> list[Feature]`` under ``@kind("name of the
joint's kind")``, and a line in ``kinds.py``; ``@force_kind`` and ``@contact_kind`` do the same for forces and
contacts. ``anchors`` says where the outlines of bodies must reach; ``items`` gives what takes room besides plates:
a convex shape with round corners that moves with one body, and a :class:`items.Reach`, which tells its heights from
the layers of bodies; ``needs`` asks for gaps between layers once these are known. Its solids are a file of their own
(``pins/pin_solids.py``), which ``kinds.py`` names too: a function under ``@build.register(Pin)`` gives eyes to plates
and adds solids to the plan; where these are few lines, a method ``build`` of the class does. The search for layers
knows nothing of kinds: it sees items alone. Solids that are general belong to shared/shapes.
"""
