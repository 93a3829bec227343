"""A slider-crank with a clearance joint beside the ideal one: 5000 rpm, two turns, as Flores and others compute it."""
