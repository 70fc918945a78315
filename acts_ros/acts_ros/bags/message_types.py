# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Message types by name: their Python classes, and their definitions and hashes as bags store them."""

from __future__ import annotations

import difflib
import importlib
import json
import re
from pathlib import Path
from typing import Any

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from rosbags.interfaces import Connection, MessageDefinitionFormat, Nodetype
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

from acts_core.errors import RecordingError


def message_class(name: str) -> type:
    """Python class of a message type.

    Parameters
    ----------
    name : str
        Such as ``acts_msgs/msg/Contact``.

    Raises
    ------
    RecordingError
        The type is not installed.
    """
    package, kind, short = _split(name)
    try:
        module = importlib.import_module(f"{package}.{kind}")
    except ImportError as error:
        raise RecordingError(
            f"unknown message type '{name}': install or source the workspace that has package '{package}'"
        ) from error
    found = getattr(module, short, None)
    if found is None:
        near = difflib.get_close_matches(short, [one for one in dir(module) if one[0].isupper()], n=1)
        what = f"did you mean {near[0]}?" if near else "it may be of another release"
        raise RecordingError(
            f"unknown message type '{name}': the package '{package}' that is installed has no such message; {what}"
        )
    assert isinstance(found, type)
    return found


class Definitions:
    """Definitions and type hashes, made from the ``.msg`` files that packages install."""

    def __init__(self) -> None:
        self._store = get_typestore(Stores.EMPTY)

    def describe(self, name: str) -> tuple[str, str]:
        """Complete definition of a type (with those it contains) and its hash.

        Parameters
        ----------
        name : str
            Such as ``acts_msgs/msg/Contact``.

        Returns
        -------
        definition, hash : str
            In the format of MCAP's ``ros2msg`` schemas, and ``RIHS01_...``.

        Raises
        ------
        RecordingError
            The ``.msg`` file of the type, or of one that it contains, is not installed.
        """
        self._load(name)
        definition, _ = self._store.generate_msgdef(name, ros_version=2)
        return definition, _installed_hash(name) or self._store.hash_rihs01(name)

    def check(self, recorded: Connection) -> None:
        """Refuse a topic that was recorded with another definition of its type than the one installed here.

        A message does not contain its type: decoded with another definition it is refused, or gives wrong numbers.
        Recordings without a definition, and types whose ``.msg`` file is not installed, are not checked.

        Parameters
        ----------
        recorded : Connection
            The topic in the bag.

        Raises
        ------
        RecordingError
            The definitions differ, or the recorded one cannot be read.
        """
        name = recorded.msgtype
        try:
            installed, type_hash = self.describe(name)
        except RecordingError:
            return
        if recorded.msgdef.format == MessageDefinitionFormat.NONE:
            same = recorded.digest in ("", type_hash)
        else:
            here = _hash(name, installed, MessageDefinitionFormat.MSG)
            same = _hash(name, recorded.msgdef.data, recorded.msgdef.format) == here
        if not same:
            raise RecordingError(
                f"{recorded.topic} was recorded with another definition of {name} than the one installed here: install "
                f"or source the version of '{name.split('/', maxsplit=1)[0]}' that it was recorded with"
            )

    def _load(self, name: str) -> None:
        if name in self._store.fielddefs:
            return
        types = get_types_from_msg(_message_file(name).read_text(), name)
        for _, fields in types.values():
            for _, field in fields:
                for inner in _names(field):
                    self._load(inner)
        self._store.register(types)


def _hash(name: str, definition: str, kind: MessageDefinitionFormat) -> str:
    """Hash of a definition, for comparison only: for types with ``char`` fields it differs from that of ROS."""
    store = get_typestore(Stores.EMPTY)
    try:
        if kind == MessageDefinitionFormat.MSG:
            store.register(get_types_from_msg(definition, name))
        for one in _idl_parts(definition) if kind == MessageDefinitionFormat.IDL else ():
            store.register(get_types_from_idl(one))
        return store.hash_rihs01(name)
    except Exception as error:  # rosbags raises errors of many types on an invalid text
        raise RecordingError(f"the recorded definition of {name} cannot be read: {error}") from error


def _idl_parts(definition: str) -> list[str]:
    """The IDL of each type of a definition as rosbag2 writes it: behind lines of 80 ``=`` and the type's name.

    Without the ``#include`` lines, which rosbags does not take.
    """
    definition = re.sub(r"^#.*$", "", definition, flags=re.MULTILINE)
    first, *others = re.split(r"^={80}\nIDL: .*$", definition, flags=re.MULTILINE)
    return [*([first] if first.strip() else []), *others]


def _split(name: str) -> tuple[str, str, str]:
    parts = name.split("/")
    if len(parts) != 3:
        raise RecordingError(f"'{name}' is not the name of a message type, such as acts_msgs/msg/Contact")
    return parts[0], parts[1], parts[2]


def _message_file(name: str) -> Path:
    package, kind, short = _split(name)
    try:
        path = Path(get_package_share_directory(package)) / kind / f"{short}.msg"
    except (PackageNotFoundError, ValueError) as error:
        raise RecordingError(f"unknown message type '{name}': there is no package '{package}'") from error
    if not path.is_file():
        raise RecordingError(f"no definition of message type '{name}': {path} does not exist")
    return path


def _installed_hash(name: str) -> str | None:
    """Hash that was computed when the package was built; None before ROS 2 Iron.

    For types with ``char`` fields it differs from the one that rosbags computes.
    """
    path = _message_file(name).with_suffix(".json")
    if not path.is_file():
        return None
    for entry in json.loads(path.read_text())["type_hashes"]:
        if entry["type_name"] == name:
            return str(entry["hash_string"])
    return None


def _names(field: Any) -> list[str]:
    """Message types that a field refers to: itself, or the items of its array or sequence."""
    kind, content = field
    if kind == Nodetype.NAME:
        return [content]
    if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
        return _names(content[0])
    return []
