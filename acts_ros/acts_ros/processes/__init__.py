"""Processes and their programs: find the executables of packages, run them, end them in order. Imports no ROS."""
