"""Piston engines: how cylinders and throws are arranged, what that leaves unbalanced, when they fire."""
