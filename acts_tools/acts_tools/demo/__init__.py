"""`acts demo`: demonstrations of the whole chain in simulation, one folder each."""
