"""Integrators, one file a method. All step along :func:`mbsd.dynamics.reference.acceleration.derivative`."""
