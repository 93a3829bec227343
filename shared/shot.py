"""Names for ``shot.py``: how a motion is filmed."""

from shared.contract.shot import Camera, Label, Section, Shot, Sound, Story, Surface, Title, Trail

__all__ = ["Camera", "Label", "Section", "Shot", "Sound", "Story", "Surface", "Title", "Trail"]
