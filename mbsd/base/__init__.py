"""What every room may use: errors, checked arguments, words for messages, codes, files written whole. It imports
none.
"""
