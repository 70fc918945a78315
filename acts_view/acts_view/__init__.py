# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Touch on a page in the browser: live, recorded, or from a board without ROS.

In come the topics of skins, a recording, or the bytes of a board; out come the page and what it shows.
"""
