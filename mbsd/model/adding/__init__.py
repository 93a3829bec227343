"""What the functions that add joints, drivers, forces and contacts share: their checks, and the entries they make."""
