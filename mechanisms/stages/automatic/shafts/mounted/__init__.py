"""What is mounted on the shafts of such a machine: gears, pulleys with belts, cams with valves over cylinders."""
