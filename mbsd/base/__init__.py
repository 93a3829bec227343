"""Foundations of every room: errors, checked arguments, words for messages, codes, files written whole. It imports
none.
"""
