"""`acts selftest`: test a board, its wiring and its skin."""
