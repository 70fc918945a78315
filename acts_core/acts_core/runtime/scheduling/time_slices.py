# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Time slices of the ordinary scheduler: short ones for threads that work briefly and must not wait long for it.

Since Linux 6.12 a thread asks by its slice to be run soon. Of the threads that have not had more than their share of a
core, the kernel runs the one with the earliest deadline. When a thread wakes up, its deadline is as far ahead as its
slice is long. So a thread with a short slice runs before the others. It gets no larger share, and needs no right. Older
kernels ignore the slice. Source: the kernel's Documentation/scheduler/sched-eevdf.rst.
"""

from __future__ import annotations

import ctypes
import os
import platform
import struct
import sys

SHORTEST_NS = 100_000
"""The shortest slice that the kernel gives [ns]."""

# Numbers of the system calls sched_setattr and sched_getattr. Python has no function for them, the C library only since
# glibc 2.41.
_NUMBERS = {"x86_64": (314, 315), "aarch64": (274, 275)}

# struct sched_attr: size, policy, flags, nice, priority, runtime, deadline, period. The runtime is the slice.
_ATTRIBUTES = struct.Struct("<IIQiIQQQ")
_ORDINARY = (os.SCHED_OTHER, os.SCHED_BATCH)


def time_slice_ns(thread: int = 0) -> int:
    """The slice of a thread under the ordinary scheduler [ns]; 0 if the kernel does not tell it.

    Parameters
    ----------
    thread : int
        Its number; 0 for the calling thread.
    """
    _, policy, _, _, _, runtime_ns, _, _ = _attributes(thread)
    return runtime_ns if policy in _ORDINARY else 0


def set_time_slice(slice_ns: int, thread: int = 0) -> None:
    """Set the slice of a thread, which those that it starts from now on inherit.

    Nothing happens if the kernel does not know slices, if the thread has ended, or if it is not under the ordinary
    scheduler.

    Parameters
    ----------
    slice_ns : int
        The kernel takes 0.1 to 100 ms [ns]; 0 for its default.
    thread : int
        Its number; 0 for the calling thread.
    """
    size, policy, flags, nice, priority, _, _, _ = _attributes(thread)
    if size and policy in _ORDINARY:
        _call(0, thread, _ATTRIBUTES.pack(size, policy, flags, nice, priority, slice_ns, 0, 0), 0)


def _attributes(thread: int) -> tuple[int, ...]:
    buffer = ctypes.create_string_buffer(_ATTRIBUTES.size)
    _call(1, thread, buffer, _ATTRIBUTES.size, 0)
    return _ATTRIBUTES.unpack(buffer.raw)


def _call(which: int, *arguments: object) -> None:
    # Errors leave everything as it is: a short slice is of use, but nothing depends on it.
    numbers = _NUMBERS.get(platform.machine())
    # A program of 32 bits has other numbers, on the same machine.
    if numbers is not None and sys.maxsize > 2**32:
        ctypes.CDLL(None).syscall(numbers[which], *arguments)
