"""How the Scotch yoke is filmed: on a bench."""

from shared.shot import Shot

shot = Shot(look="bench")
