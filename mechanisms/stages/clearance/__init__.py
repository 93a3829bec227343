"""The sweep check: no two parts touch over the whole motion. Lengths inside this package are millimetres."""
