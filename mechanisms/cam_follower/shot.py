"""How the cam is filmed: its poster shows the valve open."""

from shared.shot import Shot

shot = Shot(poster=0.11)
