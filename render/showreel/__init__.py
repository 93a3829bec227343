"""The showreel: `python -m render showreel` joins the finished films, each under its title, into one MP4."""
