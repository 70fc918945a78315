# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An interpreter of the subset of XML launch files that ROS 2 packages use, for machines without `ros2 launch`.

`parser` converts a file to the actions of `model`, `evaluate` converts those and the arguments to processes to start,
`acts_ros.processes` runs them, and `command` is `acts launch`. docs/launch.md describes the subset.
"""
