"""Kinds of insights by their subject: each file finds those of one."""
