# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Skins that are worn: what they read untouched, and what happens to them in the paper's figure 8.

In come the name of a scene and a random generator; out come full frames of the matrix, and what really happened.
"""

from acts_sim.wearables.contacts import Contact
from acts_sim.wearables.resting_skin import RestConfig, RestingSkin
from acts_sim.wearables.scene import WORN_RATE_HZ, WornScene, worn_scene
from acts_sim.wearables.scenes import SCENES, SceneKind

__all__ = ["SCENES", "WORN_RATE_HZ", "Contact", "RestConfig", "RestingSkin", "SceneKind", "WornScene", "worn_scene"]
