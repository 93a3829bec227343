"""What the formulas of all groups share: points that bodies carry, branches, and what a group is solved for."""
