"""What all packages share, without ROS: arrays, sampling schemes, force response, wire format, settings, errors."""
