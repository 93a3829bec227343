"""Revolute joints, welds, springs and bodies without joints: features and their solids."""
