"""Record topics to MCAP bags and play them; see docs/bags.md. Importing this does not import ROS."""
