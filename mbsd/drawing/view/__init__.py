"""The skeleton that moves in a browser: what carries each of its strokes, and a small page that plays them."""
