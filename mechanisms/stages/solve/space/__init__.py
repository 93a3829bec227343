"""The motion of a mechanism in space: its run, the masses of its parts, data.json and skeleton.json."""
