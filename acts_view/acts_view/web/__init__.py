# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page and its socket: who may connect, what each client has received, messages and files. Knows no ROS."""
