# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What every reflex has in common: what it is given, and what it answers with.

In come `Sensed`, one moment of the hand; out comes a `Wish` for its joints, or nothing.
"""

from acts_control.hand.reflexes.base.reflex import HandState, Reflex, Sensed, Wish

__all__ = ["HandState", "Reflex", "Sensed", "Wish"]
