"""The elevator is drawn as on a blueprint."""

from shared.shot import Shot

shot = Shot(look="blueprint")
