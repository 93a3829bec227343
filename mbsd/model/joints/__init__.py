"""Joints: what users connect bodies with, one file a kind, each made of constraints."""
