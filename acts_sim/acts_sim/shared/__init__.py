"""What the simulated processes meet by: a folder of their own, rings in shared memory, lines over sockets.

In come arrays with their time; out come those of any moment of the last 128 ms.
"""

from acts_sim.shared.lines import LineSession
from acts_sim.shared.run_folder import Claim, default_run_dir, make_private
from acts_sim.shared.timed_ring import TimedRingReader, TimedRingWriter

__all__ = ["Claim", "LineSession", "TimedRingReader", "TimedRingWriter", "default_run_dir", "make_private"]
