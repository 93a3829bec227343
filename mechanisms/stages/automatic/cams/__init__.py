"""Cams and Geneva drives: features and their solids."""
