"""The demonstration of ball balancing: run, recorded, scored and drawn."""
