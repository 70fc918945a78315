"""`acts doctor`: what this machine lacks for 1 kHz and for real time, and the command that mends it."""
