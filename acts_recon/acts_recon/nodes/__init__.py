# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `reconstruction` and its topics: the only modules of this package that know ROS.

In come frames, in memory or as messages; out come images, contacts, regions and objects.
"""
