"""Integrators, one file a method. All step along :func:`mbsd.dynamics.acceleration.derivative`."""
