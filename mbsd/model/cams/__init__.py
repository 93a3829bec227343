"""Cams: lift laws, the outline for each kind of follower, pressure angle, curvature and undercut."""
