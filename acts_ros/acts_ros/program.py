"""The executables of the packages: signals first, then the imports, then the nodes."""

from __future__ import annotations

import sys
from importlib import import_module

from acts_core.errors import ActsError
from acts_core.stop_signals import StopSignals


class Program:
    """An executable, as an entry point of ``setup.py``; imports its module when it is called.

    Parameters
    ----------
    module : str
        Name of the module; it has a function ``main(signals: StopSignals) -> int``.
    """

    def __init__(self, module: str) -> None:
        self._module = module

    def __call__(self) -> int:
        """Run it; the exit code."""
        signals = StopSignals()
        try:
            with signals.interrupting():
                module = import_module(self._module)
            return int(module.main(signals))
        except ActsError as error:
            print(f"error: {error}", file=sys.stderr, flush=True)
            return 1
        except KeyboardInterrupt:
            # Asked to end before anything had begun.
            return 0
        finally:
            signals.ended()


if __name__ == "__main__":
    # python3 -m acts_ros.program acts_driver.driver_node --ros-args ...
    sys.exit(Program(sys.argv.pop(1))())
