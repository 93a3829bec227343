"""Integrators, one file a method. All step by the operations of mbsd/dynamics/formulation.py."""
