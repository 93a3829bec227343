"""How the shaping machine is filmed: its poster shows the ram before the end of its cut."""

from shared.shot import Shot

shot = Shot(poster=0.05)
