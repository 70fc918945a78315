# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated world: what presses the skin, and the robots and motors that move it.

In come the commands that real robots and motors take; out come counts of the taxels, joint angles, and the truth for
evaluation. Robots, motors and boards speak their real protocols, so nothing else knows that they are simulated.
"""
