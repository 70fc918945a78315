"""Equipment of the measurements: boards, drivers and listeners in processes of their own, and a ROS node."""
