# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of real nodes, in this process; ROS_DOMAIN_ID 10."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import rclpy
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.parameter import Parameter

from acts_core.errors import ActsError, ArrayError, SettingsError
from acts_core.settings import Changeable, setting, validate
from acts_ros.parameters import declare, node_options, set_rate


@dataclass(frozen=True)
class Settings:
    rate_hz: float = setting(250.0, "how often", minimum=1.0, maximum=1000.0, changeable=Changeable.RUNNING)
    port: str = setting("", "which port", changeable=Changeable.UNCONFIGURED)
    home_rad: tuple[float, ...] = setting((0.0, 1.0), "where", length=2)

    def __post_init__(self) -> None:
        validate(self)


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=10)
    yield context
    rclpy.try_shutdown(context=context)


def make_node(context: Context, arguments: list[str], kind: type[Node] = Node) -> Node:
    return kind("example", namespace="/plate", context=context, cli_args=["--ros-args", *arguments], **node_options())


@pytest.mark.parametrize("kind", [Node, LifecycleNode])
def test_given_values_arrive_and_the_rest_are_defaults(context: Context, kind: type[Node]) -> None:
    node = make_node(context, ["-p", "rate_hz:=100", "-p", "home_rad:=[1.0, 2.0]"], kind)
    assert declare(node, Settings) == Settings(rate_hz=100.0, home_rad=(1.0, 2.0))
    assert node.get_parameter("rate_hz").value == 100.0
    assert list(node.get_parameter("home_rad").value) == [1.0, 2.0]
    assert node.describe_parameter("rate_hz").description == "how often"
    assert node.describe_parameter("rate_hz").floating_point_range[0].to_value == 1000.0


def test_values_come_from_a_params_file_for_any_namespace(context: Context, tmp_path: Path) -> None:
    path = tmp_path / "params.yaml"
    path.write_text("/**/example:\n  ros__parameters:\n    port: /dev/somewhere\n")
    assert declare(make_node(context, ["--params-file", str(path)]), Settings).port == "/dev/somewhere"


def test_an_unknown_parameter_is_refused_with_node_and_neighbour(context: Context) -> None:
    node = make_node(context, ["-p", "rate:=100.0"])
    with pytest.raises(SettingsError, match=r"/plate/example.*'rate'.*rate_hz"):
        declare(node, Settings)


def test_a_value_out_of_range_is_refused(context: Context) -> None:
    node = make_node(context, ["-p", "rate_hz:=5000.0"])
    with pytest.raises(SettingsError, match=r"/plate/example.*rate_hz = 5000\.0.*1 to 1000"):
        declare(node, Settings)


def test_ros_own_parameters_are_let_through(context: Context) -> None:
    node = make_node(context, ["-p", "use_sim_time:=false", "-p", "qos_overrides./x.publisher.depth:=5"])
    assert declare(node, Settings) == Settings()


@pytest.mark.parametrize("kind", [Node, LifecycleNode])
@pytest.mark.parametrize("name", ["rate_hz", "port", "home_rad"])
def test_an_empty_list_is_refused_by_the_name_of_its_parameter(context: Context, name: str, kind: type[Node]) -> None:
    with pytest.raises(SettingsError, match=rf"/plate/example: {name} = \[\]: allowed is"):
        declare(make_node(context, ["-p", f"{name}:=[]"], kind), Settings)


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("depth:=0", "depth = 0: allowed is a whole number, 1 to"),
        ("depth:=-1", "depth = -1: allowed is a whole number, 1 to"),
        ("depth:=99999999999", "depth = 99999999999: allowed is a whole number, 1 to"),
        ("depth:=many", "depth = 'many': allowed is a whole number, 1 to"),
        ("depth:=true", "depth = True: allowed is a whole number, 1 to"),
        ("depth:=[]", r"depth = \[\]: allowed is a whole number, 1 to"),
        ("reliability:=sure", "reliability = 'sure': allowed is one of reliable, best_effort"),
        ("history:=5", "history = 5: allowed is one of keep_last, keep_all"),
        ("dept:=5", "'dept' cannot be overridden; allowed are depth, history, reliability"),
    ],
)
def test_quality_of_service_that_is_none_is_refused(context: Context, override: str, said: str) -> None:
    with pytest.raises(SettingsError, match=rf"/plate/example: qos_overrides\./x\.publisher\..*{said}"):
        declare(make_node(context, ["-p", f"qos_overrides./x.publisher.{override}"]), Settings)


@pytest.mark.parametrize(
    "name", ["/x.subscriber.depth", "x.publisher.depth", "/x.depth", "/x/.publisher.depth", "/x.publisher", "depth"]
)
def test_quality_of_service_of_what_there_is_not_is_refused(context: Context, name: str) -> None:
    said = rf"/plate/example: qos_overrides\.{re.escape(name)}: needed is qos_overrides\.TOPIC\.publisher\.POLICY or"
    with pytest.raises(SettingsError, match=said):
        declare(make_node(context, ["-p", f"qos_overrides.{name}:=5"]), Settings)


def test_without_a_handler_nothing_is_changeable(context: Context) -> None:
    node = make_node(context, [])
    declare(node, Settings)
    for parameter in (
        Parameter("rate_hz", value=10.0),
        Parameter("port", value="a"),
        Parameter("home_rad", value=[0.0]),
    ):
        assert not node.set_parameters([parameter])[0].successful


def test_what_changes_is_checked_and_what_is_refused_changes_nothing(context: Context) -> None:
    changes: list[float] = []

    def take(settings: Settings) -> str:
        if settings.rate_hz == 11.0:
            return "not eleven"
        changes.append(settings.rate_hz)
        return ""

    node = make_node(context, [])
    declare(node, Settings, take)
    assert node.set_parameters([Parameter("rate_hz", value=10.0)])[0].successful
    refused = node.set_parameters([Parameter("rate_hz", value=0.0)])[0]
    assert not refused.successful
    assert "rate_hz" in refused.reason
    refused = node.set_parameters([Parameter("rate_hz", value=11.0)])[0]
    assert (refused.successful, refused.reason) == (False, "not eleven")
    assert not node.set_parameters([Parameter("home_rad", value=[3.0, 4.0])])[0].successful
    assert node.get_parameter("rate_hz").value == 10.0
    assert changes == [10.0]


def test_a_change_leaves_in_force_what_was_changed_before(context: Context) -> None:
    @dataclass(frozen=True)
    class Two:
        rate_hz: float = setting(250.0, "how often", minimum=1.0, maximum=1000.0, changeable=Changeable.RUNNING)
        taxels: int = setting(55, "how many", minimum=2, maximum=99, changeable=Changeable.RUNNING)

    changes: list[tuple[float, int]] = []

    def take(settings: Two) -> str:
        changes.append((settings.rate_hz, settings.taxels))
        return ""

    node = make_node(context, [])
    declare(node, Two, take)
    for parameter in (Parameter("rate_hz", value=10.0), Parameter("taxels", value=60)):
        assert node.set_parameters([parameter])[0].successful
    assert changes == [(10.0, 55), (10.0, 60)]
    (numbers,) = node.describe_parameter("taxels").integer_range
    assert (numbers.from_value, numbers.to_value) == (2, 99)


def test_a_timer_has_the_period_of_its_rate() -> None:
    timer: Any = SimpleNamespace(timer_period_ns=0)
    set_rate(timer, 250.0)
    assert timer.timer_period_ns == 4_000_000


def test_some_change_only_while_the_node_is_unconfigured(context: Context) -> None:
    is_unconfigured = False
    node = make_node(context, [])
    declare(node, Settings, lambda _settings: "", is_unconfigured=lambda: is_unconfigured)
    refused = node.set_parameters([Parameter("port", value="a")])[0]
    assert not refused.successful
    assert refused.reason.startswith("port can be changed only while /plate/example is unconfigured")
    # Also for those who have no `ros2`.
    for step in ("deactivate", "cleanup"):
        assert f"`acts driver -n plate {step}`" in refused.reason
    # What it has already is no change.
    assert node.set_parameters([Parameter("port", value="")])[0].successful
    is_unconfigured = True
    assert node.set_parameters([Parameter("port", value="a")])[0].successful


def test_a_change_is_refused_whatever_error_says_why(context: Context) -> None:
    @dataclass(frozen=True)
    class Arrays:
        layout: str = setting("square", "which layout", changeable=Changeable.RUNNING)

        def __post_init__(self) -> None:
            if self.layout == "round":
                raise ArrayError("layout 'round': allowed is square")

    def on_change(settings: Arrays) -> str:
        if settings.layout == "missing":
            raise ActsError("layout 'missing': no such file")
        if len(settings.layout) > 255:
            Path(settings.layout).stat()
        return ""

    node = make_node(context, [])
    declare(node, Arrays, on_change)
    for layout, reason in (("round", "allowed is square"), ("missing", "no such file"), ("a" * 300, "too long")):
        result = node.set_parameters([Parameter("layout", value=layout)])[0]
        assert not result.successful
        assert reason in result.reason
    assert node.get_parameter("layout").value == "square"


@pytest.mark.parametrize("kind", [Node, LifecycleNode])
@pytest.mark.parametrize("service", [SetParameters, SetParametersAtomically])
def test_a_value_of_no_known_type_or_for_no_parameter_is_refused_and_the_node_goes_on(
    context: Context, kind: type[Node], service: type[SetParameters] | type[SetParametersAtomically]
) -> None:
    node = make_node(context, [], kind)
    declare(node, Settings, lambda _settings: "")
    name = "set_parameters" if service is SetParameters else "set_parameters_atomically"
    client = node.create_client(service, f"example/{name}")
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)

    def ask(value: ParameterValue, name: str = "rate_hz") -> SetParametersResult:
        answer = client.call_async(service.Request(parameters=[ParameterMessage(name=name, value=value)]))
        executor.spin_until_future_complete(answer, timeout_sec=30.0)
        response = answer.result()
        return response.results[0] if service is SetParameters else response.result

    assert client.wait_for_service(30.0)
    for wrong in (10, 200, ParameterType.PARAMETER_NOT_SET):
        assert not ask(ParameterValue(type=wrong)).successful
    assert "type = 200: allowed is 0 to 9" in ask(ParameterValue(type=200)).reason
    whole = ask(ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=20))
    assert whole.reason == "rate_hz: given was a whole number; allowed is a number with a decimal point, such as 1.0"
    truth = ask(ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=True), "port")
    assert truth.reason.startswith("port: given was true or false; allowed is text; for `ros2 param set`, put on, off")
    assert "given was no value" in ask(ParameterValue(type=ParameterType.PARAMETER_NOT_SET)).reason
    assert ask(ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=20.0)).successful
    assert node.get_parameter("rate_hz").value == 20.0
    for unknown in ("", "rate", "x" * 1000):
        result = ask(ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=20.0), unknown)
        assert not result.successful
        assert result.reason == f"{unknown[:64]!r} is no parameter of /plate/example"
    assert not node.has_parameter("")
    fixed = ask(ParameterValue(type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=[3.0, 4.0]), "home_rad")
    assert not fixed.successful
    assert fixed.reason.startswith("home_rad is read when /plate/example starts, and cannot be changed later: start it")
