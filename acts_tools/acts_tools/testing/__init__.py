# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tools for launch tests, see `launch_runner`. For tests only."""
