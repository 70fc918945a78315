# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The executables of this package, see setup.py. Nothing else is imported here: signals come first."""

try:
    from acts_ros.executables.program import Program
except ModuleNotFoundError:
    from acts_core.without_ros import Program  # type: ignore[assignment]

driver = Program("acts_driver.nodes.driver_node")
