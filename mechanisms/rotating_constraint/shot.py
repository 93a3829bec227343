"""How the rotating slot is filmed: in daylight."""

from shared.shot import Shot

shot = Shot(look="daylight")
