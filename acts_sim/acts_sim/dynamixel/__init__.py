"""A bus of simulated Dynamixel motors, Protocol 2.0, that an unmodified ``dynamixel_sdk`` talks to."""
