"""How long it takes from a slider of the live page to the picture, in Chromium with WebGL in software."""
