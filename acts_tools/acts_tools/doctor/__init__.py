"""`acts doctor`: check whether this machine is ready for 1 kHz and real time, and print commands that correct it."""
