"""The pumpjack is filmed on sand, as where it works."""

from shared.shot import Shot

shot = Shot(look="sand")
