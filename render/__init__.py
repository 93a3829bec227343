"""From data.json, parts and shot to plots, stills and films. Knows neither the solver nor the mechanisms."""
