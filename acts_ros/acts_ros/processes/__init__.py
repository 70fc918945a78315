"""Find the executables of packages, run them as processes, and stop them in order. Does not import ROS."""
