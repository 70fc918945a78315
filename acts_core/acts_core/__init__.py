"""The vocabulary of ACTS, free of ROS: array geometry, sampling schemes, force response, settings, errors."""
