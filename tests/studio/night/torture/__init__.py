"""Runs of make with faults at random moments."""
