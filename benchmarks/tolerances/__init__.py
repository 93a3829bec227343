"""Four-bars whose lengths stray: how far the rocker turns at most, a hundred thousand times."""
