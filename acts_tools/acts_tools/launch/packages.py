"""What the benchmarks take of `acts_ros.processes`."""

from acts_ros.processes.packages import executable

__all__ = ["executable"]
