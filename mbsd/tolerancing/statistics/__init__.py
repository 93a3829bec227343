"""Statistics of results: derivatives, chance, worst cases, shares of the variance, yields."""
