"""Contacts in the compiled loop: when one closes, opens, slips or comes to rest in a step, and what changes then."""
