"""Many simulations of one mechanism in one compiled loop: numbers that differ, and measures of each."""
