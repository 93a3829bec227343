"""The human body as a mechanism: segment tables, figures of a height and mass, barbell exercises."""
