"""Engines: what the sweep of one costs beside a four-bar's, and how long the map of bank angles takes."""
