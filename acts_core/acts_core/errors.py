# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The errors of ACTS: one root, and a class for each thing a caller may want to handle apart."""


class ActsError(Exception):
    """Root of every error that ACTS raises on purpose.

    A message says what was given, what is allowed and what to do.
    """


class SettingsError(ActsError):
    """A setting, parameter or settings file has an unknown key, a wrong type or a value out of range."""


class ArrayError(ActsError):
    """An array has the wrong shape, type or size, or holds values that are not allowed (NaN, out of range)."""


class PacketError(ActsError):
    """Bytes from a board are not a valid packet, or bytes of a message no such message."""


class PortError(ActsError):
    """A serial port cannot be opened, or was lost."""


class BoardError(ActsError):
    """A board does not answer, or refuses what it is told."""


class DictionaryError(ActsError):
    """A dictionary file cannot be read or does not fit the array or the patch size."""


class ObjectLibraryError(ActsError):
    """An object library cannot be made or read, or does not fit the array."""


class RecordingError(ActsError):
    """A recording (npz file or bag) cannot be read or lacks what is needed."""


class CalibrationError(ActsError):
    """A baseline cannot be determined now: the skin is touched, or was not measured for long enough."""


class RobotError(ActsError):
    """The robot cannot be reached, refuses a command, or has stopped."""


class LaunchError(ActsError):
    """A launch file is not valid, or holds something outside the supported subset."""


class ViewRequestError(ActsError):
    """A page asked for something that is not understood or not allowed."""


REFUSED_EXIT_CODE = 2
"""Exit code of a process that cannot work with what it was given; starting it again is of no use."""

_REFUSALS = (SettingsError, ArrayError, DictionaryError, ObjectLibraryError)


def exit_code(error: ActsError) -> int:
    """Exit code of a process that ends with an error: `REFUSED_EXIT_CODE` where starting it again is of no use."""
    return REFUSED_EXIT_CODE if isinstance(error, _REFUSALS) else 1
