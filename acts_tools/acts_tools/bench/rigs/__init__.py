# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Equipment of the measurements: boards, drivers and listeners in processes of their own, and a ROS node."""
