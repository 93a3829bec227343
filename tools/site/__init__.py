"""The documents as a site: pages, linked sources, names of mbsd; no network, also from file://."""
