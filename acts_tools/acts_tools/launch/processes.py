"""What the demo and the benchmarks take of `acts_ros.processes`."""

from acts_ros.processes.launcher import leave_with_parent

__all__ = ["leave_with_parent"]
