"""What is shown of a skin: its shape, its newest state, and how its stream was lately. Knows no ROS."""
