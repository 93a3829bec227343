"""What a cluster costs: the coordinator for each task, and how much two workers do in the time of one."""
