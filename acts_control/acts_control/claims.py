# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Claims: of something that moves, no two programs of a machine have control at a time, whoever runs them."""

from __future__ import annotations

import errno
import hashlib
import os
import socket
import struct
import time

from acts_core.errors import ActsError
from acts_core.runtime import process_name

_CREDENTIALS = struct.Struct("3i")
_UNKNOWN = 0
# Of Linux (unix(7)), with the zero byte of an abstract name.
_ADDRESS_BYTES = 108

# What this process gave up may stay taken for a moment: a program that another thread is just starting has copies of
# all descriptors until it begins.
_COPIES_S = 0.5
_RETRY_S = 0.01

# Connections to holders of claims, by their addresses. A holder takes none of them, so each stays in its queue, which
# has room for 128: who waits for a claim asks by the same one again.
_asked: dict[bytes, socket.socket] = {}


class ClaimedError(ActsError):
    """Another program has the claim; the message names that program."""


class MachineClaim:
    """A claim of this process, held from its construction until `close`, or until the process ends, however it ends.

    A socket of an abstract name stands for the thing: Linux gives a name to one process of a machine (or container with
    a network of its own), tells the others who has it, and leaves nothing behind.

    Parameters
    ----------
    kind, name : str
        What it is, and which one.

    Raises
    ------
    ClaimedError
        With the process that has it.
    OSError
        It cannot be claimed.
    """

    def __init__(self, kind: str, name: str) -> None:
        address = _address(f"acts/{kind}/{name}".encode())
        end_s = time.monotonic() + _COPIES_S
        while True:
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            try:
                self._socket.bind(address)
                self._socket.listen()
                return
            except OSError as error:
                self._socket.close()
                if error.errno != errno.EADDRINUSE:
                    raise
                holder = _holder(address)
                if holder not in (_UNKNOWN, os.getpid()) or time.monotonic() > end_s:
                    raise ClaimedError(process_name(holder)) from error
            time.sleep(_RETRY_S)

    def close(self) -> None:
        """Give it up. May be called again."""
        self._socket.close()


def _address(name: bytes) -> bytes:
    """The socket's name; of a thing with a longer name than a socket may have, a digest stands for the end of it."""
    if len(name) >= _ADDRESS_BYTES:
        digest = hashlib.sha256(name).hexdigest().encode()
        name = name[: _ADDRESS_BYTES - 1 - len(digest)] + digest
    return b"\0" + name


def _holder(address: bytes) -> int:
    """The process that has the claim, or `_UNKNOWN`."""
    question = _asked.pop(address, None)
    if question is None or _has_ended(question):
        question = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        question.setblocking(False)
        try:
            question.connect(address)
        except OSError:
            # It has just gone, or does not answer.
            question.close()
            return _UNKNOWN
    _asked[address] = question
    data = question.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    pid, _user, _group = _CREDENTIALS.unpack(data)
    return int(pid)


def _has_ended(question: socket.socket) -> bool:
    """Whether the holder has given up the claim since it was asked; the connection is closed then."""
    try:
        question.recv(1)  # nothing ever comes
    except BlockingIOError:
        return False
    except OSError:
        pass
    question.close()
    return True
