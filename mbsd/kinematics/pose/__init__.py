"""A pose that closes, and why there is none; what can move there; consistent initial conditions."""
