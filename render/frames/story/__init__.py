"""A story as a film: its pictures rendered, what lies over them drawn, captions and chapters."""
