"""A mechanism as a model in Modelica, of the library PlanarMechanics."""
