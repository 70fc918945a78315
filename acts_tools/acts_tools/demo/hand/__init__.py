"""The demonstration of the hand's reflexes: run, recorded, scored and drawn."""
