"""Hands that move by touch: the bus of their motors, and what is known of a hand apart from it."""
