"""Driven motions in space: closed starts, mobility, Newton-Raphson along drivers, reactions."""
