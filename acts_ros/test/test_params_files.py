# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which section of a params file a parameter came from, beside what ROS itself makes of the file; ROS_DOMAIN_ID 187."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import rclpy
from hypothesis import given
from hypothesis import strategies as st
from rclpy.context import Context
from rclpy.node import Node

from acts_core.errors import SettingsError
from acts_core.settings import setting
from acts_ros.parameters import declare, node_options
from acts_ros.params_files import misnamed_sections, shared_keys


@dataclass(frozen=True)
class Settings:
    rate_hz: float = setting(250.0, "how often")


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=187)
    yield context
    rclpy.try_shutdown(context=context)


def declared(context: Context, *arguments: str) -> Settings:
    words = ["--ros-args", *arguments]
    node = Node("example", namespace="/plate", context=context, cli_args=words, **node_options())
    return declare(node, Settings, words=["program", *words])


def params_file(tmp_path: Path, text: str) -> tuple[str, str]:
    path = tmp_path / "params.yaml"
    path.write_text(text)
    return "--params-file", str(path)


FOREIGN = "{ros__parameters: {rate_hz: 10.0, other.gain: 3, deep: {er: [1, 2]}}}"


@pytest.mark.parametrize("section", ["/**", "/plate/*", "/plate/**", "/*/*", "plate: {'*'"])
def test_a_foreign_key_in_a_section_for_several_nodes_is_only_said(
    context: Context, tmp_path: Path, capfd: pytest.CaptureFixture[str], section: str
) -> None:
    end = "}" if "{" in section else ""
    text = f"{section}: {FOREIGN}{end}\n" if end else f"'{section}': {FOREIGN}\n"
    assert declared(context, *params_file(tmp_path, text)) == Settings(rate_hz=10.0)
    said = capfd.readouterr().err
    assert said.count("/plate/example has no such parameters: 'other.gain', 'deep.er'") == 1
    assert "params.yaml, section /" in said


@pytest.mark.parametrize("section", ["/plate/example", "/**/example", "/*/example", "plate/example"])
def test_a_foreign_key_in_a_nodes_own_section_is_refused(context: Context, tmp_path: Path, section: str) -> None:
    text = f"'{section}': {{ros__parameters: {{rats_hz: 10.0}}}}\n"
    with pytest.raises(SettingsError, match=r"/plate/example: unknown key 'rats_hz'; did you mean 'rate_hz'"):
        declared(context, *params_file(tmp_path, text))
    # Also where a section for several nodes has it, too.
    with pytest.raises(SettingsError, match="rats_hz"):
        declared(context, *params_file(tmp_path, text + "/**: {ros__parameters: {rats_hz: 10.0}}\n"))


def test_a_nested_section_is_its_own_and_another_nodes_is_nobodys(context: Context, tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="rats_hz"):
        declared(context, *params_file(tmp_path, "plate: {example: {ros__parameters: {rats_hz: 10.0}}}"))
    text = (
        "/**: {ros__parameters: {x: 1}}\n/plate/other: {ros__parameters: {x: 1}}\n/example: {ros__parameters: {x: 1}}"
    )
    assert declared(context, *params_file(tmp_path, text)) == Settings()


@pytest.mark.parametrize("section", ["example", "/example", "/plate/exmple", "/**/exampel", "plate: {examples"])
def test_a_section_that_nearly_names_the_node_is_said(
    context: Context, tmp_path: Path, capfd: pytest.CaptureFixture[str], section: str
) -> None:
    text = f"{section}: {{ros__parameters: {{rate_hz: 10.0, more: 1}}}}" + "}" * section.count("{")
    assert declared(context, *params_file(tmp_path, text)) == Settings()
    said = capfd.readouterr().err
    assert said.count("is not for /plate/example, and ignored; did you mean /**/example?") == 1


@pytest.mark.parametrize("section", ["/plate/other", "/left/example", "/left/exmple", "/**", "/*/example", "/ball"])
def test_a_section_of_another_node_or_of_this_one_is_not_said(tmp_path: Path, section: str) -> None:
    file = params_file(tmp_path, f"'{section}': {{ros__parameters: {{rate_hz: 10.0}}}}")
    assert misnamed_sections("/plate/example", ["x", "--ros-args", *file]) == []


@pytest.mark.parametrize("section", ["/plat/example", "plat: {example", "/plates/example"])
def test_a_section_of_nearly_the_nodes_namespace_is_said(
    context: Context, tmp_path: Path, capfd: pytest.CaptureFixture[str], section: str
) -> None:
    text = f"{section}: {{ros__parameters: {{rate_hz: 10.0}}}}" + "}" * section.count("{")
    assert declared(context, *params_file(tmp_path, text)) == Settings()
    name = section.replace(": {", "/").strip("/")
    said = f"section /{name} is not for /plate/example, and ignored; did you mean /plate/example?"
    assert capfd.readouterr().err.count(said) == 1


@pytest.mark.parametrize(
    "sections", [["/right/example"], ["/skin_2/example"], ["/skins_1/example", "/skin_1/example"], ["/skins_1/other"]]
)
def test_of_a_file_for_several_the_section_of_another_is_not_said(tmp_path: Path, sections: list[str]) -> None:
    text = "".join(f"{section}: {{ros__parameters: {{rate_hz: 1.0}}}}\n" for section in sections)
    assert misnamed_sections("/skin_1/example", ["x", "--ros-args", *params_file(tmp_path, text)]) == []


@pytest.mark.parametrize(
    "nodes", [["ball_state", "ball_control", "ball_trajectory"], ["hand_control", "ball_control"], ["driver", "drives"]]
)
def test_of_a_file_for_nodes_whose_names_are_only_alike_no_section_is_said(tmp_path: Path, nodes: list[str]) -> None:
    text = "".join(f"/**/{node}: {{ros__parameters: {{rate_hz: 1.0}}}}\n" for node in nodes)
    file = params_file(tmp_path, text)
    for node in nodes:
        assert misnamed_sections(f"/plate/{node}", ["x", "--ros-args", *file]) == []


@pytest.mark.parametrize("section", ["/example", "example", "/**", "/**/example", "/*"])
def test_of_a_node_without_a_namespace_its_own_sections_are_not_said(tmp_path: Path, section: str) -> None:
    file = params_file(tmp_path, f"'{section}': {{ros__parameters: {{rate_hz: 1.0}}}}\n")
    assert misnamed_sections("/example", ["x", "--ros-args", *file]) == []


def test_a_section_for_another_depth_or_a_longer_name_gives_a_node_nothing_of_its_own(tmp_path: Path) -> None:
    def shared(node: str, section: str) -> list[str]:
        text = f"/**: {{ros__parameters: {{a: 1}}}}\n'{section}': {{ros__parameters: {{a: 1}}}}\n"
        return list(shared_keys(node, ["x", "--ros-args", *params_file(tmp_path, text)]))

    for node, section in (("/plate/driver_2", "/plate/driver"), ("/a/b/driver", "/*/driver"), ("/driver", "/*/driver")):
        assert shared(node, section) == ["a"]
    for node, section in (("/a/driver", "/*/driver"), ("/driver", "/**/driver"), ("/a/b/driver", "/**/driver")):
        assert shared(node, section) == []


def test_a_key_on_the_command_line_is_refused_even_if_a_file_has_it(context: Context, tmp_path: Path) -> None:
    file = params_file(tmp_path, "/**: {ros__parameters: {rats_hz: 10.0}}")
    for words in (["-p", "rats_hz:=1.0"], ["--param", "example:rats_hz:=1.0"]):
        with pytest.raises(SettingsError, match="rats_hz"):
            declared(context, *file, *words)


def test_a_key_of_another_node_on_the_command_line_is_not_this_ones(context: Context, tmp_path: Path) -> None:
    file = params_file(tmp_path, "/**: {ros__parameters: {rows: 10, rate_hz: 5.0}}")
    assert declared(context, *file, "-p", "other:rows:=16") == Settings(rate_hz=5.0)


def test_a_key_with_the_nodes_name_but_not_its_namespace_is_said(
    context: Context, capfd: pytest.CaptureFixture[str]
) -> None:
    assert declared(context, "-p", "example:rate_hz:=10.0", "-p", "other:rate_hz:=20.0") == Settings()
    said = "-p example:rate_hz is for /example, not for /plate/example, and ignored; did you mean the section /**/ex"
    errors = capfd.readouterr().err
    assert errors.count(said) == errors.count("ignored") == 1
    assert misnamed_sections("/example", ["x", "--ros-args", "-p", "example:rate_hz:=10.0"]) == []


def test_what_cannot_be_read_shares_nothing(tmp_path: Path) -> None:
    assert shared_keys("/a", ["x", "--ros-args", "--params-file"]) == {}
    assert shared_keys("/a", ["x", "--ros-args", "--params-file", str(tmp_path / "none.yaml")]) == {}
    # Words outside of ROS's own mean something else.
    file = params_file(tmp_path, "/**: {ros__parameters: {a: 1}}")
    assert shared_keys("/a", ["x", *file, "--ros-args", "-r", "b:=c", "--", *file]) == {}
    assert list(shared_keys("/a", ["x", "--ros-args", *file])) == ["a"]


def test_a_file_may_have_letters_beyond_ascii_but_none_that_are_no_utf_8(tmp_path: Path) -> None:
    path = tmp_path / "params.yaml"
    words = ["x", "--ros-args", "--params-file", str(path)]
    text = "# Größe\n/**: {ros__parameters: {a: 1}}\n"
    path.write_text(text, encoding="utf-8")
    assert list(shared_keys("/a", words)) == ["a"]
    # As ROS does, which refuses it.
    path.write_text(text, encoding="latin-1")
    assert shared_keys("/a", words) == {}


def test_what_is_nested_too_deeply_shares_nothing(tmp_path: Path) -> None:
    """ROS reads it; the node ended with a traceback."""
    file = params_file(tmp_path, f"/**: {{ros__parameters: {{a: {'[' * 2000}{']' * 2000}}}}}\n")
    assert shared_keys("/a", ["x", "--ros-args", *file]) == {}


def test_a_tag_of_pythons_is_not_carried_out(tmp_path: Path) -> None:
    file = params_file(tmp_path, "/**: {ros__parameters: {a: !!python/object/apply:os.abort []}}")
    assert list(shared_keys("/a", ["x", "--ros-args", *file])) == ["a"]


@given(st.text(alphabet="/*a:{}[] \n\t-&!'\"ros__parameters", max_size=60))
def test_any_text_is_a_file(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_text(text)
    shared_keys("/a/b", ["x", "--ros-args", "--params-file", str(path)])


def test_the_settings_of_a_file_for_all_nodes_reach_each(context: Context, tmp_path: Path) -> None:
    text = "/**: {ros__parameters: {rate_hz: 5.0}}\n/**/example: {ros__parameters: {rate_hz: 6.0}}\n"
    assert declared(context, *params_file(tmp_path, text)) == Settings(rate_hz=6.0)
