"""The human body as a machine: segment tables, a figure of given height and mass, exercises with a barbell."""
