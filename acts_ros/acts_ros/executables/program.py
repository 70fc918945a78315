# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Entry points of the executables: signal handlers first, then imports, then nodes."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from acts_core.errors import REFUSED_EXIT_CODE, ActsError, exit_code
from acts_core.names import own_words
from acts_core.stop_signals import StopSignals
from acts_ros.executables.middleware_choice import check_middleware
from acts_ros.executables.missing_packages import advice_about
from acts_ros.executables.refused import stay, take_stay_word
from acts_ros.executables.shared_memory import check_shared_memory
from acts_ros.executables.standby import PREPARE_AFTER_S, Standby, say_ready, take_standby_word
from acts_ros.executables.streams import open_streams


class Program:
    """An executable, as an entry point of ``setup.py``; imports its module when it is called.

    Parameters
    ----------
    module : str
        Name of the module, with a function ``main(signals: StopSignals) -> int``. If it has ``SETTINGS``, the settings
        class of each of its nodes by the node's name, ``--help`` prints its docstring and parameters; else ``main``
        handles ``--help``. If it has a function ``prepare()``, a spare process (`acts_ros.executables.standby`) calls
        it before it waits: it does what ``main`` would otherwise need time for.
    """

    def __init__(self, module: str) -> None:
        self._module = module

    def __call__(self) -> int:
        """Run the program and return its exit code."""
        open_streams()
        stays = take_stay_word(sys.argv)
        code = self._run(take_standby_word(sys.argv))
        if code == REFUSED_EXIT_CODE and stays:
            stay()
        return code

    def _run(self, standby: Standby | None) -> int:
        signals = StopSignals()
        try:
            with signals.interrupting():
                is_spare = standby is not None and not standby.wait_for_turn(PREPARE_AFTER_S)
                # The nodes' matrices are small: a second thread gains nothing, and busy-waits for a tenth of a second.
                os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
                # Imported modules stay: searching them for garbage again and again takes a tenth of the start-up.
                gc.disable()
                check_shared_memory()
                check_middleware(os.environ)
                module = import_module(self._module)
                gc.freeze()
                gc.enable()
                if hasattr(module, "SETTINGS") and _asks_for_help(sys.argv[1:]):
                    help_page = import_module("acts_ros.executables.program_help")
                    print(help_page.program_help(Path(sys.argv[0]).name, module.__doc__ or "", module.SETTINGS))
                    return 0
                if standby is not None and is_spare:
                    if hasattr(module, "prepare"):
                        module.prepare()
                    say_ready()
                    standby.wait_for_turn()
            return int(module.main(signals))
        except ActsError as error:
            print(f"error: {error}", file=sys.stderr, flush=True)
            return exit_code(error)
        except ImportError as error:
            advice = advice_about(error)
            if not advice:
                raise
            print(f"error: {advice}", file=sys.stderr, flush=True)
            return REFUSED_EXIT_CODE
        except SystemExit as error:
            # argparse refuses a command line so, after it has said why.
            return error.code if isinstance(error.code, int) else int(error.code is not None)
        except KeyboardInterrupt:
            # Stopped before the program had started.
            return 0
        finally:
            signals.ended()


def _asks_for_help(words: Sequence[str]) -> bool:
    """Whether the words of a command line ask for help; ROS arguments are ignored."""
    own = own_words(words)
    return "-h" in own or "--help" in own


if __name__ == "__main__":
    # python3 -m acts_ros.executables.program acts_driver.nodes.driver_node --ros-args ...
    sys.exit(Program(sys.argv.pop(1))())
