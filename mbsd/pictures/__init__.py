"""Results of drawing: a picture, a page or a film that a notebook shows and a script keeps."""
