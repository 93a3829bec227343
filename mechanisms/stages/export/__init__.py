"""A mechanism and its motion for other programs: tables, drawings and an assembly of a pose, models of simulators."""
