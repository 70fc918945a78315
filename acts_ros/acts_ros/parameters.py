# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings dataclasses as ROS parameters, with description and range, and checked when they change."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

from acts_core.errors import ActsError, SettingsError
from acts_core.settings import (
    Changeable,
    SettingInfo,
    checked,
    default_of,
    describe,
    from_mapping,
    unknown_key_message,
)
from acts_ros.parameter_service import CheckedParameterService
from acts_ros.params_files import misnamed_sections, shared_keys
from acts_ros.qos import OVERRIDES, check_overrides

T = TypeVar("T")

_ROS_OWN = ("use_sim_time", "start_type_description_service")


def node_options() -> dict[str, Any]:
    """Keyword arguments that a node using `declare` passes to ``Node.__init__``.

    The services of the parameters are made by `declare`. ROS is not to declare what is given: for an empty list it
    would end the process, without the parameter's name.
    """
    return {"start_parameter_services": False}


def declare(
    node: Node,
    settings_class: type[T],
    on_change: Callable[[T], str] | None = None,
    *,
    is_unconfigured: Callable[[], bool] = lambda: False,
    words: Sequence[str] | None = None,
) -> T:
    """Declare every setting of a dataclass as a parameter of `node`, and return the settings with the given values.

    Call it once per node. Values come from the command line, the params file or the defaults. Unknown parameters in a
    section of a params file for several nodes (``/**``) are ignored and logged, and so are sections whose name is
    nearly that of the node.

    Parameters
    ----------
    node : rclpy.node.Node
        Constructed with ``**node_options()``.
    settings_class : type
        Dataclass of `acts_core.settings.setting` fields.
    on_change : callable or None
        Called with the changed settings, after they were checked as a whole, like the first values. Returns "" where
        they are in force now, else why they are refused. None: all parameters are fixed, also those whose setting
        says that they may be changed.
    is_unconfigured : callable
        Whether the node is unconfigured now; only then may settings with `Changeable.UNCONFIGURED` change.
    words : sequence of str or None
        Command line, to find the section that a value came from; None for that of the process.

    Raises
    ------
    SettingsError
        For an unknown parameter, a wrong type or a value out of range, naming node, parameter and what is allowed; also
        where ``qos_overrides`` are none (`acts_ros.qos.check_overrides`).
    """
    where = node.get_fully_qualified_name()
    infos = describe(settings_class)
    given = _given(node)
    words = sys.argv if words is None else words
    for sentence in misnamed_sections(where, words):
        node.get_logger().warning(sentence)
    unknown = [name for name in given if name not in infos and not name.startswith(OVERRIDES)]
    _judge_unknown(node, unknown, list(infos), words)
    try:
        check_overrides(given)
        known = {name: value for name, value in given.items() if name in infos}
        settings = from_mapping(settings_class, known, where)
    except SettingsError as error:
        raise SettingsError(f"parameters of {where}: {error}") from None
    for name, info in infos.items():
        default = default_of(settings_class, name)
        value = getattr(settings, name)
        is_fixed = on_change is None or info.changeable is Changeable.AT_START
        node.declare_parameter(name, ros_value(value), _descriptor(default, info, is_fixed), ignore_override=True)
    if on_change is not None:
        node.add_on_set_parameters_callback(_Changes(where, settings, on_change, is_unconfigured))
    CheckedParameterService(node)
    return settings


def _given(node: Node) -> dict[str, Any]:
    """What the command line, params files and the node's maker give, but for what ROS has read already."""
    return {
        # Of an empty list, ROS does not know of what, and takes it for no value.
        name: [] if parameter.type_ is Parameter.Type.NOT_SET else parameter.value
        # rclpy has no other name for them: its methods know declared parameters only.
        for name, parameter in node._parameter_overrides.items()
        if name not in _ROS_OWN
    }


def _judge_unknown(node: Node, unknown: Sequence[str], known: Sequence[str], words: Sequence[str]) -> None:
    """Refuse unknown parameters that were given to this node; log those from a section for several nodes."""
    where = node.get_fully_qualified_name()
    if not unknown:
        return
    shared = shared_keys(where, words)
    for name in unknown:
        if name not in shared:
            raise SettingsError(unknown_key_message(name, known, f"parameters of {where}"))
    sections = ", ".join(dict.fromkeys(shared[name] for name in unknown))
    node.get_logger().warning(
        f"ignored, because {where} has no such parameters: {', '.join(map(repr, unknown))} "
        f"(given for several nodes, by {sections})"
    )


def ros_value(value: Any) -> Any:
    """Convert the value of a setting to the value of a ROS parameter."""
    return list(value) if isinstance(value, tuple) else value


def set_rate(timer: Timer, rate_hz: float) -> None:
    """Set the rate of a timer [Hz], from its next call on."""
    timer.timer_period_ns = round(1e9 / rate_hz)


def _descriptor(default: Any, info: SettingInfo, read_only: bool) -> ParameterDescriptor:
    descriptor = ParameterDescriptor(
        description=info.description, additional_constraints=info.allowed, read_only=read_only
    )
    lowest, highest = info.minimum, info.maximum
    # ROS ranges have two ends; a one-sided limit is in the description, and `checked` enforces it.
    if isinstance(default, bool) or lowest is None or highest is None:
        return descriptor
    if isinstance(default, int):
        descriptor.integer_range = [IntegerRange(from_value=int(lowest), to_value=int(highest), step=0)]
    elif isinstance(default, float):
        floating = FloatingPointRange(from_value=float(lowest), to_value=float(highest), step=0.0)
        descriptor.floating_point_range = [floating]
    return descriptor


class _Changes:
    """Checks changed parameters and passes them to `on_change`; holds those in force."""

    def __init__(
        self, where: str, settings: Any, on_change: Callable[[Any], str], is_unconfigured: Callable[[], bool]
    ) -> None:
        self._where = where
        self._settings = settings
        self._on_change = on_change
        self._is_unconfigured = is_unconfigured

    def __call__(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        infos = describe(type(self._settings))
        given = {parameter.name: parameter.value for parameter in parameters if parameter.name in infos}
        if not given:
            return SetParametersResult(successful=True)
        try:
            changed = dataclasses.replace(
                self._settings,
                **{
                    name: checked(name, value, default_of(type(self._settings), name), infos[name])
                    for name, value in given.items()
                },
            )
            reason = self._too_late(changed) or self._on_change(changed)
        # The system's own refusals, of a path for instance, are answers too: raised, they would end the process.
        except (ActsError, OSError, ValueError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        if reason:
            return SetParametersResult(successful=False, reason=reason)
        self._settings = changed
        return SetParametersResult(successful=True)

    def _too_late(self, changed: Any) -> str:
        """Why a change is not allowed in this state of the node; empty where it is."""
        if self._is_unconfigured():
            return ""
        for name, info in describe(type(changed)).items():
            value = getattr(changed, name)
            if info.changeable is Changeable.UNCONFIGURED and value != getattr(self._settings, name):
                # Of the nodes of ACTS only a driver has this state.
                ask = f"acts driver -n {self._where.rpartition('/')[0].lstrip('/') or '/'}"
                return (
                    f"{name} can be changed only while {self._where} is unconfigured: `{ask} deactivate` and `{ask} "
                    f"cleanup` before, `configure` and `activate` after (or `ros2 lifecycle set {self._where} ...`)"
                )
        return ""
