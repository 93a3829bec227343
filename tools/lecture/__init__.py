"""docs/lecture.ipynb, run cell by cell, with what it printed and drew kept beside its code."""
