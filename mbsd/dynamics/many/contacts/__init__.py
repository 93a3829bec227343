"""Contacts without friction in the compiled loop: when one closes or opens within a step, and what changes then."""
