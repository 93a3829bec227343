"""Makes the solids: STL, STEP and parts.json. It imports loading, solve and automatic."""
