"""What measurements are made with: boards, drivers and listeners in processes of their own, and the ROS graph."""
