"""A model shown: skeleton with the standard symbols (matplotlib, extra ``draw``), and its topology as SVG."""
