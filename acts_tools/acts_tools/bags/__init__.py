# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The commands that record topics to MCAP bags and play them; see docs/bags.md. Importing this does not import ROS."""
