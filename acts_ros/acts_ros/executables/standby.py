# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A spare process takes over at once when the one that works dies.

Most of a restart is spent on importing and preparing. A launch file may therefore start the same process twice, with
`STANDBY_WORD`. The first one works. The other one imports, prepares, and waits; when the first one dies, it works, and
what the launch starts in place of the dead one becomes the spare.

Which one works is decided by an abstract socket of Linux (unix(7)): one process at a time has its name, and the kernel
closes it, and the connections to it, in the moment the process ends.
"""

from __future__ import annotations

import errno
import os
import select
import socket
import struct
import time
import zlib
from collections.abc import MutableSequence
from pathlib import Path

from acts_core.errors import ActsError
from acts_core.names import own_words

STANDBY_WORD = "--standby"
"""Argument of equal processes of a launch, of which one at a time is to work."""

PREPARE_AFTER_S = 10.0
"""So long a spare waits before it imports, so as not to slow down the start of the others."""

_RETRY_S = 0.01
_NAMESPACE_RULE = "__ns:="
# struct ucred of Linux: process, user, group.
_CREDENTIALS = struct.Struct("3i")


class Standby:
    """The turn of one of several equal processes of the same parent.

    Parameters
    ----------
    name : str
        What the processes are, with what tells them from other processes of the launch; up to 64 characters.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._address = f"\0acts/standby/{os.getppid()}/{name}"
        self._turn: socket.socket | None = None

    def wait_for_turn(self, timeout_s: float | None = None) -> bool:
        """Wait until no other process works; whether that was so in time [s], which is then for this one to do.

        Raises
        ------
        ActsError
            If a process of another user has taken the name of the socket.
        """
        deadline_s = None if timeout_s is None else time.monotonic() + timeout_s
        while not self._take_turn():
            left_s = None if deadline_s is None else max(0.0, deadline_s - time.monotonic())
            if not self._wait_for_end_of_other(left_s):
                return False
        return True

    def close(self) -> None:
        """Let another process have its turn, as the end of this process does."""
        if self._turn is not None:
            self._turn.close()
            self._turn = None

    def _take_turn(self) -> bool:
        turn = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            turn.bind(self._address)
            turn.listen()
        except OSError as error:
            turn.close()
            if error.errno != errno.EADDRINUSE:
                raise
            return False
        self._turn = turn
        return True

    def _wait_for_end_of_other(self, timeout_s: float | None) -> bool:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as other:
            try:
                other.connect(self._address)
            except ConnectionRefusedError:
                # It has just ended, or does not listen yet.
                time.sleep(_RETRY_S)
                return timeout_s is None or timeout_s > 0.0
            _, user, _ = _CREDENTIALS.unpack(other.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size))
            if user != os.getuid():
                raise ActsError(
                    f"{self._name} cannot be a spare process: a process of user {user} has taken the name "
                    f"{self._address[1:]!r}. Launch with standby:=false, or end that process."
                )
            # Nothing is ever sent: readable is what it becomes when the other process ends.
            return bool(select.select([other], [], [], timeout_s)[0])


def take_standby_word(words: MutableSequence[str]) -> Standby | None:
    """Remove `STANDBY_WORD` from a command line; with it, the turns of this process and of those equal to it."""
    if STANDBY_WORD not in words:
        return None
    words.remove(STANDBY_WORD)
    namespace = next((word.partition(_NAMESPACE_RULE)[2] for word in words if word.startswith(_NAMESPACE_RULE)), "")
    # A process of the same name with other arguments, as those of another board, is no spare of this one. In a number,
    # because the name of a socket is short.
    equal = zlib.crc32(os.fsencode("\0".join([_container(), namespace.strip("/"), *own_words(words)[1:]])))
    return Standby(f"{Path(words[0]).name}/{equal:08x}")


def _container() -> str:
    """Where the numbers of processes are counted: those of two containers are alike, and may share the network."""
    try:
        return str(Path("/proc/self/ns/pid").readlink())
    except OSError:
        return ""


def say_ready() -> None:
    """Print that this process is a spare and can take over."""
    print("ready to take over if the process that works ends", flush=True)
