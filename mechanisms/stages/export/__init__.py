"""A mechanism and its motion for other programs: tables, drawings, assemblies, simulator models."""
