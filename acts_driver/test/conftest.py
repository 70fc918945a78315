# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Message fields are checked in every test, however it is started."""

import os

os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")
