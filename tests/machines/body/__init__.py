"""The human body: segment tables, lifts and their published moments."""
