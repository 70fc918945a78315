"""Which section of a params file a parameter came from. ROS hands a node only what all sections come to."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import yaml

_PARAMETERS = "ros__parameters"


def shared_keys(node: str, words: Sequence[str]) -> dict[str, str]:
    """Parameters that a node is given only because a section of a params file is for several nodes.

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
        File and section by the parameter's name; without those that are given by name as well, or on the command line.
    """
    shared: dict[str, str] = {}
    own: set[str] = set()
    for option, value in _ros_options(words):
        if option in ("-p", "--param"):
            own.add(value.partition(":=")[0].rpartition(":")[2])
            continue
        for section, key in _keys_of_file(Path(value)):
            if not re.fullmatch(_pattern(section), node):
                continue
            if section.endswith("*"):
                shared.setdefault(key, f"{value}, section {section}")
            else:
                own.add(key)
    return {key: place for key, place in shared.items() if key not in own}


def _ros_options(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    """What ROS is told about parameters: option and value."""
    is_ros = False
    for word, following in zip(words, [*words[1:], ""], strict=True):
        if word in ("--ros-args", "--"):
            is_ros = word == "--ros-args"
        elif is_ros and word in ("-p", "--param", "--params-file"):
            yield word, following


def _pattern(section: str) -> str:
    """A section's name as a regular expression, as ROS understands it."""
    escaped = re.escape(section).replace(r"/\*\*", r"(/\w+)*")
    return escaped.replace(r"/\*", r"/\w+")


def _keys_of_file(path: Path) -> Iterator[tuple[str, str]]:
    """Name of a section and of a parameter in it, for all in a params file; none where it cannot be read as such.

    Values are not looked at: what a parameter may be, ROS has judged.
    """
    try:
        root = yaml.compose(path.read_text(encoding="utf-8"), Loader=yaml.SafeLoader)
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return
    for names, value in _entries(root, ()):
        if _PARAMETERS in names and not isinstance(value, yaml.MappingNode):
            depth = names.index(_PARAMETERS)
            section = "/" + "/".join(name.strip("/") for name in names[:depth] if name.strip("/"))
            yield section, ".".join(names[depth + 1 :])


def _entries(node: yaml.Node | None, names: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], yaml.Node]]:
    """Every entry of nested mappings, with the keys that lead to it."""
    if not isinstance(node, yaml.MappingNode):
        return
    for key, value in node.value:
        path = (*names, str(key.value))
        yield path, value
        yield from _entries(value, path)
