"""The demonstrations: `acts demo ball_balancing`."""
