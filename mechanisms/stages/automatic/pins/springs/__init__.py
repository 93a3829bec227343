"""Springs, dampers, actuators and ropes between two points: their room, and the studs that hold their ends."""
