"""The hunt: random mechanisms of all kinds, each solved again in other words (see ``case.py``)."""
