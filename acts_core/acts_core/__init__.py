# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What all packages share, without ROS: arrays, sampling schemes, force response, wire format, settings, errors."""
