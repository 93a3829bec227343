"""Parts of machines whose bodies have places z along the normal of the plane: engines, pumps, walkers.

In this order, a file each; lengths are millimetres, and z of the parts is that of the model:

    bodies/              in which plane each joint acts; what each body becomes
    rams.py              beams, clevises and columns of what several links drive along ground
    knuckles.py          rods that carry other rods in their own plane
    cylinders.py         bores, from strokes, rods and neighbours
    banks.py             cylinders in line, fins and decks
    thickness.py         how thick links may be beside each other
    free_places.py       places of links that the model gives none, by the search for layers
    shaft_plan.py        crank pins, webs and journals of a shaft
    pins_along.py        pins between links, and axles on ground
    mounted/             gears, pulleys with belts, cams with valves
    bearers.py           pillars and bearings of shafts
    passing.py           whether all of this passes each other
    along.py             the plan
    solids/              shafts with counterweights for what they carry, links, pistons, liners with heads and decks,
                         rams, bearings, axles
"""
