"""The solids of a mechanism: STL, STEP and parts.json, from parts.py or automatic."""
