# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The reconstruction: images and contacts from the samples of each frame.

In come samples; out come images with their uncertainty, contacts, forces, and the object that presses. Only `nodes`
needs ROS.
"""
