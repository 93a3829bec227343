"""Parts of machines whose bodies have places z along the normal of the plane: engines, pumps, walkers.

In this order, a file each; lengths are millimetres, and z of the parts is that of the model:

    planes.py            in which plane each joint acts
    machine.py           what each body becomes: a shaft, a link in one plane, a piston
    cylinders.py         bores, from strokes, rods and neighbours
    banks.py             cylinders in line, fins and decks
    thickness.py         how thick links may be beside each other
    free_places.py       places of links that the model gives none, by the search for layers
    shaft_plan.py        crank pins, webs and journals of a shaft
    pins_along.py        pins between links, and axles on ground
    bearers.py           pillars and bearings of shafts
    passing.py           whether all of this passes each other
    along.py             the plan
    solids/              shafts, links, pistons, liners with heads and decks, bearings, axles
"""
