"""The motion of a mechanism: masses, the run, data.json and skeleton.json."""
