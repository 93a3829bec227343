"""Closed-form kinematics of mechanisms that fall apart into driven bodies and Assur groups of one or two bodies."""
