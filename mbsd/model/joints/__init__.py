"""Joints: what users connect bodies with, each made of constraints."""
