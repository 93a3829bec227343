"""Many simulations of one mechanism: numbers that differ, one compiled loop over them, measures instead of solutions."""
