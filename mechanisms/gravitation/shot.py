"""How the planets are filmed: before the dark."""

from shared.shot import Shot

shot = Shot(look="studio")
