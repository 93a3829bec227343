"""Parts of machines whose bodies have places z along the normal of the plane: engines, pumps, walkers.

In this order, a chapter each; lengths are millimetres, and z of the parts is that of the model:

    bodies.py           roles of bodies, the planes in which their joints act, and rods that carry other rods
    machine.py          the machine that a model describes
    rams.py             beams, clevises and columns of bodies that several links drive along ground
    cylinders.py        bores, from strokes, rods and neighbours
    shaft_plan.py       thickness of links beside each other; crank pins, webs and journals of a shaft
    valves.py, wheels.py  cams with valves; gears, and pulleys with belts
    passing.py          the check that all of this passes each other; cylinders in line, fins and decks
    bearings.py         pins between links, axles on ground, free places of links, pillars and bearings of shafts
    along.py            the plan
    solids.py           all solids: shaft_solids.py with counterweights, link_solids.py, cylinder_solids.py
"""
