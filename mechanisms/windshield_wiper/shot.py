"""How the wiper is filmed: out on the road."""

from shared.shot import Shot

shot = Shot(look="road")
