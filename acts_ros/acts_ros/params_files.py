# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which section of a params file a parameter came from, and what is wrong with a file. ROS tells a node neither."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import yaml

from acts_core.errors import SettingsError
from acts_core.files import read_text

_PARAMS_FILE = "--params-file"
_PARAMETERS = "ros__parameters"
_NEAR = 0.85


def shared_keys(node: str, words: Sequence[str]) -> dict[str, str]:
    """Parameters that a node gets only from sections of params files that are for several nodes.

    Such a section has a name that ends in a wildcard, as in ``/**`` and ``/plate/*``. ``/**/driver`` names its node.

    Parameters
    ----------
    node : str
        Full name, such as ``/plate/driver``.
    words : sequence of str
        Command line of its process, with ``--ros-args``.

    Returns
    -------
    dict of str to str
        File and section by the parameter's name; without parameters that a section of this node only, or the command
        line, gives as well.
    """
    shared: dict[str, str] = {}
    own: set[str] = set()
    for option, value in _ros_options(words):
        if option != _PARAMS_FILE:
            given_to, key = _node_and_key(value)
            # With a node's name before it, it is for no other.
            if given_to in ("", node.rpartition("/")[2]):
                own.add(key)
            continue
        for section, key in _keys_of_file(Path(value)):
            if not re.fullmatch(_pattern(section), node):
                continue
            if section.endswith("*"):
                shared.setdefault(key, f"{value}, section {section}")
            else:
                own.add(key)
    return {key: place for key, place in shared.items() if key not in own}


def misnamed_sections(node: str, words: Sequence[str]) -> list[str]:
    """Sections of params files that look meant for a node but give it nothing, which ROS passes over silently.

    They have the node's name without its namespace, or nearly its name; or its name in nearly its namespace, where no
    section is for this node alone. Of namespaces that are only numbered differently, each is another's.

    So it is with ``-p NODE:NAME:=VALUE`` on the command line, which is for ``/NODE``.

    Parameters
    ----------
    node, words
        As of `shared_keys`.

    Returns
    -------
    list of str
        A sentence about each, with the name that is right.
    """
    own_place, _, name = node.rpartition("/")
    said = []
    for option, value in _ros_options(words):
        given_to, key = _node_and_key(value)
        if option != _PARAMS_FILE and own_place and given_to == name:
            said.append(
                f"{option} {given_to}:{key} is for /{name}, not for {node}, and ignored; did you mean the section "
                f"/**/{name} of a params file?"
            )
    given_files = [Path(value) for option, value in _ros_options(words) if option == _PARAMS_FILE]
    sections = dict.fromkeys((path, section) for path in given_files for section, _ in _keys_of_file(path))
    has_own = any(section == node for _, section in sections)
    for file, section in sections:
        place, _, given = section.rpartition("/")
        if re.fullmatch(_pattern(section), node):
            continue
        lacks_namespace = section == f"/{name}"
        is_misspelt = given != name and difflib.get_close_matches(given, [name], cutoff=_NEAR)
        if lacks_namespace or (is_misspelt and re.fullmatch(_pattern(f"{place}/{name}"), node)):
            said.append(f"{file}: section {section} is not for {node}, and ignored; did you mean /**/{name}?")
        elif given == name and not has_own and _is_misspelt(place, own_place):
            said.append(f"{file}: section {section} is not for {node}, and ignored; did you mean {node}?")
    return said


def given_to_all(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Name and value, as text, of parameters that a command line gives to all nodes of its process (``-p``)."""
    for option, value in _ros_options(words):
        given_to, key = _node_and_key(value)
        if option != _PARAMS_FILE and not given_to:
            yield key, value.partition(":=")[2]


def more_of(refusal: str, words: Sequence[str]) -> str:
    """What ROS leaves out where it refuses a command line; empty where nothing is known.

    Parameters
    ----------
    refusal : str
        What ROS says.
    words : sequence of str
        The command line.
    """
    for option, value in _ros_options(words):
        if f"'{option} {value}'" not in refusal:
            continue
        if option != _PARAMS_FILE:
            return f"an empty text is written {value}\"''\"" if value.endswith(":=") else ""
        try:
            yaml.compose(read_text(Path(value), error=SettingsError), Loader=yaml.SafeLoader)
        except (SettingsError, yaml.YAMLError, RecursionError) as error:
            return " ".join(str(error).split())
    return ""


def _is_misspelt(place: str, meant: str) -> bool:
    """Whether a namespace is nearly another, and not only of another number."""
    one, other = (re.sub(r"\d+", "", text) for text in (place, meant))
    return one != other and bool(difflib.get_close_matches(place, [meant], cutoff=_NEAR))


def _ros_options(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Options of ROS about parameters, each with its value."""
    is_ros = False
    for word, following in zip(words, [*words[1:], ""], strict=True):
        if word in ("--ros-args", "--"):
            is_ros = word == "--ros-args"
        elif is_ros and word in ("-p", "--param", _PARAMS_FILE):
            yield word, following


def _node_and_key(rule: str) -> tuple[str, str]:
    """The node, or none, and the parameter of ``NODE:NAME:=VALUE`` or ``NAME:=VALUE``."""
    given_to, _, key = rule.partition(":=")[0].rpartition(":")
    return given_to, key


def _pattern(section: str) -> str:
    """Regular expression of a section's name, with the wildcards of ROS."""
    escaped = re.escape(section).replace(r"/\*\*", r"(/\w+)*")
    return escaped.replace(r"/\*", r"/\w+")


def _keys_of_file(path: Path) -> Iterator[tuple[str, str]]:
    """Section and parameter name of every parameter in a params file; none where the file is not valid.

    Values are not checked: ROS has done that.
    """
    try:
        root = yaml.compose(path.read_text(encoding="utf-8"), Loader=yaml.SafeLoader)
    except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError):
        return
    for names, value in _entries(root, ()):
        if _PARAMETERS in names and not isinstance(value, yaml.MappingNode):
            depth = names.index(_PARAMETERS)
            section = "/" + "/".join(name.strip("/") for name in names[:depth] if name.strip("/"))
            yield section, ".".join(names[depth + 1 :])


def _entries(node: yaml.Node | None, names: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], yaml.Node]]:
    """Every entry of nested mappings, with its path of keys."""
    if not isinstance(node, yaml.MappingNode):
        return
    for key, value in node.value:
        path = (*names, str(key.value))
        yield path, value
        yield from _entries(value, path)
