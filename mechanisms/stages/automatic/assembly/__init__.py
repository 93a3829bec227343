"""From a plan to solids: plates of the bodies, the base, engraved words."""
