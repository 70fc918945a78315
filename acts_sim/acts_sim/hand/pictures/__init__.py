# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of the simulated hand: rendered, or drawn from its kinematics."""

from acts_sim.hand.pictures.drawing import draw_hand
from acts_sim.hand.pictures.picture import HandPicture

__all__ = ["HandPicture", "draw_hand"]
