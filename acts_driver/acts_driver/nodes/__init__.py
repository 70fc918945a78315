# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `driver` and its topics and services: the only modules of this package that know ROS.

In come parameters and a source of bytes; out come the topics. Each module is one part of the node.
"""
