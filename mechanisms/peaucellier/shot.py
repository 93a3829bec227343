"""How Peaucellier's linkage is filmed: its poster has the rhombus open."""

from shared.shot import Shot

shot = Shot(look="blueprint", poster=0.06)
