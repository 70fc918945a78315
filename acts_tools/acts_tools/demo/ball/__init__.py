"""The demonstration of ball balancing: watched, scored and drawn."""
