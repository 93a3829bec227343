"""Constraints F(x, y, a) of the relative pose of two markers, one file an equation.

Each is compiled when a model first uses it.
"""
