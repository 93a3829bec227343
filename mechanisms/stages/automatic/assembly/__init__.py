"""From the plan to solids: plates, the base, engraved words."""
