"""Numbers with units and counted things, written the same in messages and pictures."""

from mbsd.base.quantity import MINUS, angle_step, counted, figures, labelled, live, prefixed, written

__all__ = ["MINUS", "angle_step", "counted", "figures", "labelled", "live", "prefixed", "written"]
