"""Springs, ropes, belts and trails: what changes its shape along the film."""
