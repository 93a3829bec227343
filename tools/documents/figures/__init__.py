"""Pictures of docs/: drawn by the file of the page's name in ``pages/``, on light and on dark paper."""
