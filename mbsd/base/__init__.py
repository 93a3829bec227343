"""Foundations of every room: errors, checked arguments, words, codes, files written whole.

They import no other room.
"""
