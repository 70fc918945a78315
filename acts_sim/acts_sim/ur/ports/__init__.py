# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The TCP ports of the simulated UR controller (RTDE, script, dashboard and test hooks), and their server.

In come bytes from clients; out come bytes for clients, and calls of the controller.
"""

from acts_sim.ur.ports import dashboard, hooks
from acts_sim.ur.ports.script import ScriptSession
from acts_sim.ur.ports.server import Port, Server
from acts_sim.ur.ports.session import RtdePort

__all__ = ["Port", "RtdePort", "ScriptSession", "Server", "dashboard", "hooks"]
