"""Settings dataclasses as ROS parameters: declared with description and range, unknown ones refused."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection
from typing import Any, TypeVar

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from acts_core.errors import SettingsError
from acts_core.settings import SettingInfo, checked, default_of, describe, from_mapping, unknown_key_message

T = TypeVar("T")

_ROS_OWN = ("use_sim_time", "start_type_description_service")
_ROS_OWN_PREFIXES = ("qos_overrides.",)


def node_options() -> dict[str, Any]:
    """Keyword arguments that a node using `declare` passes to ``Node.__init__``.

    Overrides are declared first, so that `declare` sees also the ones that nobody asked for; without that, ROS drops a
    misspelt parameter silently.
    """
    return {"automatically_declare_parameters_from_overrides": True}


def declare(
    node: Node,
    settings_class: type[T],
    *,
    changeable: Collection[str] = (),
    on_change: Callable[[T], str] = lambda settings: "",
) -> T:
    """Declare every setting of a dataclass as a parameter of `node` and return the values given to them.

    Call it once a node. Values come from the params file, the command line or the defaults.

    Parameters
    ----------
    node : rclpy.node.Node
        Constructed with ``**node_options()``.
    settings_class : type
        Dataclass of `acts_core.settings.setting` fields.
    changeable : collection of str
        Parameters that may be set while the node runs; the others only at its start. What is set together is checked
        like the first values, and as a whole.
    on_change : callable
        Takes settings with the changes, after they were checked, and returns why they cannot be; empty where they
        are in force now.

    Raises
    ------
    SettingsError
        For an unknown parameter, a wrong type or a value out of range, naming node, parameter and what is allowed.
    """
    where = node.get_fully_qualified_name()
    infos = describe(settings_class)
    given: dict[str, Any] = {}
    for name in [str(name) for name in node.get_parameters_by_prefix("")]:
        if name in _ROS_OWN or name.startswith(_ROS_OWN_PREFIXES):
            continue
        if name not in infos:
            raise SettingsError(unknown_key_message(name, list(infos), f"parameters of {where}"))
        given[name] = node.get_parameter(name).value
        node.undeclare_parameter(name)
    try:
        settings = from_mapping(settings_class, given, where)
    except SettingsError as error:
        raise SettingsError(f"parameters of {where}: {error}") from None
    for name, info in infos.items():
        default = default_of(settings_class, name)
        value = getattr(settings, name)
        node.declare_parameter(
            name, ros_value(value), _descriptor(default, info, name not in changeable), ignore_override=True
        )
    if changeable:
        node.add_on_set_parameters_callback(_Changes(settings, on_change))
    return settings


def ros_value(value: Any) -> Any:
    """A value of a setting as the value of a ROS parameter."""
    return list(value) if isinstance(value, tuple) else value


def _descriptor(default: Any, info: SettingInfo, read_only: bool) -> ParameterDescriptor:
    descriptor = ParameterDescriptor(
        description=info.description, additional_constraints=info.allowed, read_only=read_only
    )
    lowest, highest = info.minimum, info.maximum
    # ROS ranges have two ends; a one-sided one is told in words and checked by `checked`.
    if isinstance(default, bool) or lowest is None or highest is None:
        return descriptor
    if isinstance(default, int):
        descriptor.integer_range = [IntegerRange(from_value=int(lowest), to_value=int(highest), step=0)]
    elif isinstance(default, float):
        floating = FloatingPointRange(from_value=float(lowest), to_value=float(highest), step=0.0)
        descriptor.floating_point_range = [floating]
    return descriptor


class _Changes:
    """Checks changed parameters and hands them on; remembers those in force."""

    def __init__(self, settings: Any, on_change: Callable[[Any], str]) -> None:
        self._settings = settings
        self._on_change = on_change

    def __call__(self, parameters: list[Parameter]) -> SetParametersResult:
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
        except SettingsError as error:
            return SetParametersResult(successful=False, reason=str(error))
        reason = self._on_change(changed)
        if reason:
            return SetParametersResult(successful=False, reason=reason)
        self._settings = changed
        return SetParametersResult(successful=True)
