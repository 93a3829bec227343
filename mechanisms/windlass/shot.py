"""The windlass is filmed before a bright bend of paper."""

from shared.shot import Shot

shot = Shot(look="cyclorama")
