"""Bodies that only Newton-Raphson places, in independent coordinates: a cam's follower, a Geneva's wheel, a triad."""
