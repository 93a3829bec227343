"""How the leg is filmed: its poster has the foot on its way back."""

from shared.shot import Shot

shot = Shot(look="sand", poster=0.55)
