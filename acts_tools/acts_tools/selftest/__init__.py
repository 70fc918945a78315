"""`acts selftest`: is the board, its wiring and its skin sound?"""
