"""Which bank angle suits which engine: the tables of docs/engines.md and out/engines/ (``make study-engines``)."""
