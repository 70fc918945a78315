# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Nodes of a process with parameters of their own from its command line: ``--set NODE.PARAMETER=VALUE``.

A ROS parameter on the command line (``-p name:=value``) goes to all nodes of a process, and nodes without it refuse it.
Also, a launch argument always overrides the params file, even with its default; here `IN_PARAMS_FILE` sets nothing.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.utilities import remove_ros_args

from acts_core.errors import SettingsError
from acts_core.settings import describe, from_text, unknown_key_message
from acts_core.stop_signals import StopSignals
from acts_ros.executor import run
from acts_ros.middleware import telling_wrong_arguments
from acts_ros.parameters import ros_value
from acts_ros.params_files import given_to_all

IN_PARAMS_FILE = "params_file"
"""Value that sets nothing: the parameter comes from the params file, or is the default."""


def run_nodes(
    nodes: Mapping[str, Callable[..., Node]],
    settings: Mapping[str, type],
    signals: StopSignals | None,
    args: Sequence[str] | None,
) -> int:
    """`acts_ros.executor.run` with the parameters that the command line gives to each node.

    Parameters
    ----------
    nodes : mapping of str to callable
        What makes each node, by its name, from its ``parameter_overrides``; in the order in which they are made.
    settings : mapping of str to type
        Settings class of each node, by its name.
    signals, args
        As of `acts_ros.executor.run`.

    Returns
    -------
    int
        Exit code.

    Raises
    ------
    SettingsError
        As of `parameters_from`.
    """
    words = list(sys.argv if args is None else args)
    given = parameters_from(words, settings)
    return run([partial(make, parameter_overrides=given[name]) for name, make in nodes.items()], words, signals)


def parameters_from(words: Sequence[str], nodes: Mapping[str, type]) -> dict[str, list[Parameter]]:
    """The parameters that a command line gives to the nodes of a process.

    Parameters
    ----------
    words : sequence of str
        The command line, the program's name first; ROS arguments are ignored.
    nodes : mapping of str to type
        Settings class of each node, by the node's name.

    Returns
    -------
    dict of str to list of Parameter
        For each node, to be passed as ``parameter_overrides``; they override params files.

    Raises
    ------
    SettingsError
        For an unknown node or parameter, with the nearest known name, a value of the wrong type, ROS arguments that ROS
        refuses, or a parameter of one node that they give to all.
    """
    # --help is answered before, see acts_ros.executables.program.
    usage = "%(prog)s [--set NODE.PARAMETER=VALUE ...] [--ros-args -p NAME:=VALUE --params-file FILE ...]"
    parser = argparse.ArgumentParser(usage=usage, add_help=False)
    parser.add_argument("--set", metavar="NODE.PARAMETER=VALUE", action="append", default=[])
    with telling_wrong_arguments(words):
        own = remove_ros_args(list(words))[1:]
    options = parser.parse_args(own)
    _refuse_for_all(words, nodes)
    given: dict[str, dict[str, Parameter]] = {node: {} for node in nodes}
    for text in options.set:
        name, equals, value = text.partition("=")
        node, dot, parameter = name.partition(".")
        if not (equals and dot):
            raise SettingsError(f"--set {text}: needed is NODE.PARAMETER=VALUE, with NODE one of {', '.join(nodes)}")
        if node not in nodes:
            raise SettingsError(unknown_key_message(node, list(nodes), "nodes of this process"))
        settings_class = nodes[node]
        if parameter not in describe(settings_class):
            raise SettingsError(unknown_key_message(parameter, list(describe(settings_class)), f"parameters of {node}"))
        if value == IN_PARAMS_FILE:
            continue
        # Given twice, the last one is used.
        given[node][parameter] = Parameter(parameter, value=ros_value(from_text(settings_class, parameter, value)))
    return {node: list(parameters.values()) for node, parameters in given.items()}


def _refuse_for_all(words: Sequence[str], nodes: Mapping[str, type]) -> None:
    """Refuse ``-p NAME:=VALUE`` where some of the nodes have such a parameter: the others would not say which."""
    for name, value in given_to_all(words):
        having = [node for node, settings_class in nodes.items() if name in describe(settings_class)]
        lacking = [node for node in nodes if node not in having]
        if having and lacking:
            instead = " ".join(f"--set {node}.{name}={value}" for node in having)
            raise SettingsError(
                f"-p {name}:={value} is for all nodes of this process, of which {', '.join(lacking)} cannot take it: "
                f"give {instead} before --ros-args"
            )
