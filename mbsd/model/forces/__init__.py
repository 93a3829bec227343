"""Kinds of forces, in chapters; mbsd/model/force.py says what a kind is made of."""
