"""Does a board and its skin work? Judged from its frames: untouched, and while a hand is rolled over the skin."""
