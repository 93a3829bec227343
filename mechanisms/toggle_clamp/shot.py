"""How the clamp is filmed: a hand moves it, and no motor hums."""

from shared.shot import Shot, Sound

shot = Shot(sound=Sound(silent=("hand",)))
