"""What launch tests are written with: `launch_runner`. For tests only."""
