"""`acts demo`: the whole chain with everything simulated, one folder for each demonstration."""
