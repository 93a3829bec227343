"""Forward dynamics: M a + J^T lam = Q, J a = gamma, from consistent initial conditions."""
