"""Standard symbols of joints, wheels, cams, contacts and loads."""
