"""The showreel: `python -m render showreel` joins the finished films, with titles, into one MP4."""
