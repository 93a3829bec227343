"""The valve gear is filmed in the studio."""

from shared.shot import Shot

shot = Shot(look="studio")
