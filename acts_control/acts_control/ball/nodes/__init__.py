# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of ball balancing, together or one by one.

In comes the topic `contact`; out go the ball's state, the reference, and the arm's motion.
"""
