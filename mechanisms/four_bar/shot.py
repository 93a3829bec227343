"""How the four-bar is filmed."""

from shared.shot import Shot, Trail

shot = Shot(
    look="studio",
    turns=3,
    seconds_per_turn=4.0,
    fps=30,
    trails=(Trail(point="P"),),
    poster=0.3,
)
