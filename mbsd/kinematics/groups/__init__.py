"""Closed-form kinematics of mechanisms of driven bodies and Assur groups of one or two bodies."""
