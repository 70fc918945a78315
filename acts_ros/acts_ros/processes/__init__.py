# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Find the executables of packages, run them as processes, and stop them in order. Does not import ROS."""
