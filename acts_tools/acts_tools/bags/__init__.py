"""Recording topics to MCAP bags and publishing them again; see docs/bags.md. Importing this imports no ROS."""
