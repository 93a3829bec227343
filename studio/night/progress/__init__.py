"""What a run knows of its films while it works: pictures, pace, forecast, errors."""
