"""The server of the live page: it watches a mechanism's files, solves on saving and pushes what has changed."""
