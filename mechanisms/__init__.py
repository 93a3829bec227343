"""Mechanisms, a folder each, and the stages that make their files."""
