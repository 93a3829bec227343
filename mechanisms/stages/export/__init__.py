"""A mechanism and its motion for other programs: tables, drawings of a pose, models of robot simulators."""
