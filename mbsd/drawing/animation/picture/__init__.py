"""One picture of the film: the page, its panels, arrows at their scale, names, trails."""
