"""Progress of a run on its films: pictures, pace, forecast, errors."""
