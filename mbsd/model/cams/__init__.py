"""Cams: lift laws, the disc's outline for each kind of follower, pressure angle, curvature and undercut."""
