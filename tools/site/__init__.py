"""The documents as a site: pages, sources that they link to, names of mbsd; no network, also from file://."""
