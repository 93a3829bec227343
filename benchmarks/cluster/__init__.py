"""Cost of a cluster: the coordinator's for each task, and how much two workers do in the time of one."""
