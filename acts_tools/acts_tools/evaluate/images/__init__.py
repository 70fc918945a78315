"""How well images are recovered: recordings sampled as a board would, recovered by a method, scored frame by frame."""
