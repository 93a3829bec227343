"""What arrows and bars of a film stand for: motions, loads, the flow of energy."""
