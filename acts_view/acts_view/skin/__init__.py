# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is shown of a skin: its shape, its newest state, and how its stream was lately. Knows no ROS."""
