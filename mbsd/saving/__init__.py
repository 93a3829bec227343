"""Models as JSON files: the document, its file, its published schema. Led by the registries."""
