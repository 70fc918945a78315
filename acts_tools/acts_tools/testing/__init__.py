"""Tools for launch tests, see `launch_runner`. For tests only."""
