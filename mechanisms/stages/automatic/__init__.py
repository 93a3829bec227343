"""Parts by themselves: from the model and its motion to solids, without a parts.py.

In this order, a file each:

    sizes.py     one scale from the links' lengths; all is laid out in reference millimetres (rmm), pins 8 rmm thick
    motion.py    poses of all bodies over the motion
    kinds.py     each joint becomes a feature: places that bodies must reach, what takes room, how high gaps must be
    points.py    traced points, free ends, lone centres of mass: features without a joint
    layout.py    outlines of bodies round the features' places; which items meet in the plane (planar.py)
    layers.py    the search for an order of layers (rules as clauses: layer_clauses.py); refusal.py: why there is none
    decided.py   which thickness of pins, which layers; pivots that must hang get bridges (bridges.py)
    heights.py   layers become heights
    plan.py      features give bodies their eyes, and add hardware
    built.py     plates (body_shape.py, marks.py), base (frame.py) and hardware become solids, scaled to millimetres
    automatic.py the face

How a kind of joint is added: a module with a class that has the four methods of :class:`features.Feature`
(``pins.py`` is the pattern), a function ``gather(m, joints, layout) -> list[Feature]`` under ``@kind("name of the
joint's kind")``, and a line in ``kinds.py``; ``@force_kind`` and ``@contact_kind`` do the same for forces and
contacts. ``anchors`` says where the outlines of bodies must reach; ``items`` gives what takes room besides plates:
a convex shape with round corners that moves with one body, and a :class:`items.Reach`, which tells its heights from
the layers of bodies; ``needs`` asks for gaps between layers once these are known; ``build`` gives eyes to plates
and adds solids to the plan. The search for layers knows nothing of kinds: it sees items alone. Solids that are
general belong to shared/shapes.
"""
