"""Mechanisms, one folder each, and the stages that turn them into files."""
