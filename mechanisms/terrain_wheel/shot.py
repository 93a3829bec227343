"""How the wheel is filmed: on sand."""

from shared.shot import Shot

shot = Shot(look="sand")
