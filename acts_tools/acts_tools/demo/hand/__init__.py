"""The demonstration of the hand's reflexes: played, watched, scored and drawn."""
