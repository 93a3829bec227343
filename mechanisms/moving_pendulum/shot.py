"""How the pendulum on its cart is filmed: in daylight."""

from shared.shot import Shot

shot = Shot(look="cyclorama")
