# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Launch files to command lines: what real ROS 2 launch would start, and its words for what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fake_prefix import Launch, Prefix, words

from acts_core.errors import LaunchError
from acts_tools.launch.evaluate import evaluate

PARAM = '<node pkg="fake" exec="node"><param name="a" value="{}"/></node>'
FAR_TOO_LONG = (5000 * "9", f"0x{5000 * 'f'}", 3000 * "[")
NODE = '<node pkg="fake" exec="node" args="{}"/>'


def test_a_node_gets_name_namespace_parameters_and_remaps_in_the_real_order(
    launch: Launch, node: Path, prefix: Prefix
) -> None:
    params = prefix.share("params.yaml", "/**:\n  ros__parameters:\n    a: 1\n")
    plan = launch(
        """
        <group>
          <push-ros-namespace namespace="robot"/>
          <push_ros_namespace namespace="plate"/>
          <node pkg="fake" exec="node" name="driver" namespace="left" args="--fast 'two words' --x=$(var x 7)">
            <param from="$(find-pkg-share fake)/params.yaml"/>
            <param name="rate" value="1000"/>
            <remap from="samples" to="/raw"/>
          </node>
        </group>
        """
    )
    (process,) = plan.processes
    written = process.parameter_files[0]
    assert process.label == "node-1"
    assert list(process.command) == [
        *(str(node), "--fast", "two words", "--x=7", "--ros-args"),
        *("-r", "__node:=driver", "-r", "__ns:=/robot/plate/left"),
        *("--params-file", str(params), "--params-file", str(written), "-r", "samples:=/raw"),
    ]
    assert yaml.safe_load(written.read_text()) == {"/robot/plate/left/driver": {"ros__parameters": {"rate": 1000}}}


def test_an_executable_gets_its_words_and_environment_and_nothing_of_ros(launch: Launch, node: Path) -> None:
    plan = launch(
        """
        <group>
          <push-ros-namespace namespace="robot"/>
          <set_env name="GIVEN" value="to all"/>
          <executable cmd="$(exec-in-pkg node fake) --fast 'two words' --x=$(var x 'a b') --end" name="board"
                      output="screen" respawn="true" respawn_delay="2.0">
            <env name="OWN" value="$(var x 7)"/>
          </executable>
          <executable cmd="sh"/>
        </group>
        """
    )
    board, shell = plan.processes
    assert (board.label, board.output, board.respawn, board.respawn_delay_s) == ("board-1", "screen", True, 2.0)
    assert list(board.command) == [str(node), "--fast", "two words", "--x=a b", "--end"]
    assert (board.environment["GIVEN"], board.environment["OWN"]) == ("to all", "7")
    assert (shell.label, len(shell.command), "OWN" in shell.environment) == ("sh-2", 1, False)


def test_an_executable_is_looked_up_in_its_own_path(launch: Launch, node: Path) -> None:
    body = f'<executable cmd="node"><env name="PATH" value="{node.parent}"/></executable>'
    assert launch(body).processes[0].command == (str(node),)
    with pytest.raises(LaunchError, match="executable 'sh' not found on the PATH"):
        launch(body.replace("node", "sh", 1))


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("<executable/>", "Attribute 'cmd'"),
        ('<executable cmd=""/>', "cmd is empty|not found on the PATH"),
        ('<executable cmd="no_such_program_anywhere"/>', "'no_such_program_anywhere' not found on the PATH"),
        ('<executable cmd="$(exec-in-pkg nothing fake)"/>', "executable 'nothing' not found on the libexec directory"),
        ('<executable cmd="$(exec-in-pkg node)"/>', "exec-in-package substitution expects 2 arguments"),
        ('<executable cmd="sh" shell="true"/>', "Unexpected attribute.*'shell'"),
        ('<executable cmd="sh"><param name="a" value="1"/></executable>', "Unexpected nested tag.*'param'"),
        ('<executable cmd="sh" respawn_delay="-1"/>', "respawn_delay of Entity executable"),
    ],
)
def test_an_executable_that_cannot_be_is_refused(launch: Launch, body: str, words: str) -> None:
    with pytest.raises(LaunchError, match=words):
        launch(body)


def test_a_node_without_name_or_namespace_gets_neither_and_its_parameters_match_any_node(launch: Launch) -> None:
    plan = launch('<node pkg="fake" exec="node"><param name="a" value="1"/></node>')
    path = str(plan.processes[0].parameter_files[0])
    assert words(plan) == [["--ros-args", "--params-file", path]]
    assert yaml.safe_load(Path(path).read_text()) == {"/**": {"ros__parameters": {"a": 1}}}


@pytest.mark.parametrize(
    ("pushed", "own", "namespace"),
    [
        (None, "a", "/a"),
        (None, "/a/", "/a"),
        ("p", "a", "/p/a"),
        ("p", "/a", "/a"),
        ("/p/", None, "/p"),
        ("p", "", "/p"),
        (None, "", "/"),
        ("/", "a", "/a"),
    ],
)
def test_namespaces_join_unless_absolute(launch: Launch, pushed: str | None, own: str | None, namespace: str) -> None:
    push = "" if pushed is None else f'<push-ros-namespace namespace="{pushed}"/>'
    attribute = "" if own is None else f'namespace="{own}"'
    assert words(launch(f'{push}<node pkg="fake" exec="node" {attribute}/>')) == [
        ["--ros-args", "-r", f"__ns:={namespace}"]
    ]


@pytest.mark.parametrize(
    ("attributes", "value"),
    [
        ('value="123"', 123),
        ('value="123" type="str"', "123"),
        ('value="1.5"', 1.5),
        ('value="1" type="float"', 1.0),
        ('value="true"', True),
        ('value="1" type="bool"', True),
        ('value="[1, $(var two)]"', [1, 2]),
        ('value="$(var two)"', 2),
        ('value="$(var two)" type="str"', "2"),
        ('value="$(var list)"', [4, 5]),
        ('value="[1.0, 2.5]" type="list_of_float"', [1.0, 2.5]),
        ('value="plain"', "plain"),
        ('value=""', ""),
    ],
)
def test_parameters_get_the_type_yaml_or_the_file_gives_them(launch: Launch, attributes: str, value: object) -> None:
    plan = launch(
        '<let name="two" value="2"/><let name="list" value="[4, 5]"/>'
        f'<node pkg="fake" exec="node"><param name="a" {attributes}/></node>'
    )
    (path,) = plan.processes[0].parameter_files
    read = yaml.safe_load(path.read_text())["/**"]["ros__parameters"]["a"]
    assert read == value
    assert type(read) is type(value)


def test_a_group_ends_the_scope_of_variables_environment_and_namespace_unless_told_otherwise(launch: Launch) -> None:
    body = """
      <group{}>
        <let name="a" value="in"/><set_env name="MARK" value="in"/><push-ros-namespace namespace="in"/>
        <node pkg="fake" exec="node"/>
      </group>
      <node pkg="fake" exec="node" args="$(var a out) $(env MARK out)"/>
    """
    scoped, unscoped = launch(body.format("")), launch(body.format(' scoped="false"'))
    assert words(scoped)[1] == ["out", "out", "--ros-args"]
    assert words(unscoped)[1] == ["in", "in", "--ros-args", "-r", "__ns:=/in"]
    assert scoped.processes[0].environment["MARK"] == "in"
    assert "MARK" not in scoped.processes[1].environment


def test_an_include_passes_arguments_changes_the_scope_and_has_its_own_dirname(launch: Launch, prefix: Prefix) -> None:
    prefix.launch(
        "inner.launch.xml",
        '<arg name="p" default="0"/><arg name="q" default="$(dirname)"/><let name="b" value="inner"/>'
        + NODE.format("$(var p) $(var q)"),
        package="other",
    )
    plan = launch(
        '<include file="$(find-pkg-share other)/launch/inner.launch.xml"><arg name="p" value="1"/></include>'
        + NODE.format("$(var b) $(var p) $(dirname)")
    )
    share = prefix.path / "share"
    assert words(plan) == [
        ["1", str(share / "other/launch"), "--ros-args"],
        ["inner", "1", str(share / "fake/launch"), "--ros-args"],
    ]


def test_conditions_choose_and_later_lines_win(launch: Launch) -> None:
    body = """
      <arg name="sim" default="true"/>
      <let name="port" value="real" unless="$(var sim)"/>
      <let name="port" value="simulated" if="$(var sim)"/>
      <group if="$(var sim)"><node pkg="fake" exec="node" args="world"/></group>
      <node pkg="fake" exec="node" args="$(var port)" unless="false"/>
      <node pkg="fake" exec="node" args="never" if="0"/>
    """
    assert [line[0] for line in words(launch(body))] == ["world", "simulated"]
    assert [line[0] for line in words(launch(body, sim="FALSE"))] == ["real"]


def test_undeclared_arguments_are_set_and_known_as_undeclared(launch: Launch) -> None:
    plan = launch('<arg name="known" default="1"/>' + NODE.format("$(var other none)"), other="2")
    assert words(plan)[0][0] == "2"
    assert plan.declared == {"known"}


def test_what_the_file_logs_is_told_where_its_condition_holds(launch: Launch) -> None:
    plan = launch(
        '<arg name="sim" default="true"/><log message="sim is $(var sim)"/><log message="never" unless="$(var sim)"/>'
    )
    assert plan.messages == ["sim is true"]


def test_two_nodes_of_one_name_are_a_warning(launch: Launch) -> None:
    one = '<node pkg="fake" exec="node" name="n" namespace="a"/>'
    assert launch(one + one).warnings == [
        "there are now at least 2 nodes with the name /a/n created within this launch context"
    ]


def test_respawn_output_and_programs_outside_of_packages(launch: Launch) -> None:
    plan = launch('<node exec="sh" respawn="true" respawn_delay="1.5" output="both"/>' + NODE.format(""))
    shell, plain = plan.processes
    assert Path(shell.command[0]).name == "sh"
    assert (shell.respawn, shell.respawn_delay_s, shell.output) == (True, 1.5, "both")
    assert (plain.respawn, plain.respawn_delay_s, plain.output) == (False, 0.0, "log")


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("<foo/>", "Unrecognized entity of the type: foo"),
        ("<remap from='a' to='b'/>", "Unrecognized entity of the type: remap"),
        ('<node pkg="fake" exec="node" bogus="1"/>', "Unexpected attribute(s) found in `node`: {'bogus'}"),
        ('<node pkg="fake" exec="node"><foo/></node>', "Unexpected nested tag(s) found in `node`: {'foo'}"),
        ('<log level="INFO" message="a"/>', "Unexpected attribute(s) found in `log`: {'level'}"),
        ("<log/>", "Attribute 'message' of type '<class 'str'>' not found in Entity 'log'"),
        ('<node pkg="fake"/>', "Attribute 'exec' of type '<class 'str'>' not found in Entity 'node'"),
        ('<node pkg="nope" exec="node"/>', "package 'nope' not found, searching: ["),
        ('<node pkg="fake" exec="nope"/>', "executable 'nope' not found on the libexec directory"),
        ('<node exec="no-such-program"/>', "executable 'no-such-program' not found on the PATH"),
        ('<node pkg="fake" exec="node" name="a-b"/>', "'a-b' is no name of a node: allowed are letters, digits"),
        ('<node pkg="fake" exec="node" namespace="a b"/>', "'/a b' is no namespace: allowed are letters"),
        (
            '<push-ros-namespace namespace="9a"/>',
            "'9a' is no namespace: allowed are letters, digits (not first) and _, parts with one / between",
        ),
        (
            '<push-ros-namespace namespace="arm"/><push-ros-namespace namespace="a//b"/>',
            "'a//b' within '/arm' is no namespace",
        ),
        (
            '<node pkg="fake" exec="node"><remap from="a"/></node>',
            "Attribute 'to' of type '<class 'str'>' not found in Entity 'remap'",
        ),
        (
            '<node pkg="fake" exec="node"><param name="a"/></node>',
            "either a value attribute or nested params are needed",
        ),
        (
            '<node pkg="fake" exec="node"><param name="a" from="b"/></node>',
            "name and from attributes are mutually exclusive",
        ),
        ('<node pkg="fake" exec="node"><param value="1"/></node>', "param Entity should have name or from attribute"),
        (
            '<node pkg="fake" exec="node"><param name="a" value="1" allow_substs="true"/></node>',
            "Unexpected attribute(s) found in `param`: {'allow_substs'}",
        ),
        (
            '<node pkg="fake" exec="node"><param name="a" value="1" type="wrong"/></node>',
            "Got invalid type identifier 'wrong'",
        ),
        ('<node pkg="fake" exec="node"><param name="a" value="x" type="int"/></node>', "Cannot convert value 'x'"),
        ('<node pkg="fake" exec="node"><param name="a" value="{b: 1}"/></node>', "Cannot convert value '{b: 1}'"),
        *(
            (PARAM.format(value + kind), "Cannot convert value '")
            for value in ("2024-13-45", "[2024-13-45, $(dirname)]", "!!bool x", "!!timestamp x", *FAR_TOO_LONG)
            for kind in ("", '" type="yaml', '" type="list_of_int', '" type="bool')
        ),
        *(
            (f'<let name="b" value="{value}"/>{PARAM.format("$(var b)")}', value)
            for value in ("2024-13-45", *FAR_TOO_LONG)
        ),
        (
            '<node pkg="fake" exec="node"><param from="/no/such.yaml"/></node>',
            "Parameter file path is not a file: /no/such.yaml",
        ),
        (NODE.format("$(var zz)"), "launch configuration 'zz' does not exist"),
        (NODE.format("'$(var x 1)'"), "No closing quotation"),
        ('<group if="yes"/>', "invalid condition expression, expected one of [true, 1, false, 0] but got 'yes'"),
        ('<group if="1" unless="1"/>', "if and unless conditions can't be used simultaneously"),
        ('<group if="true"><arg name="need"/></group>', 'Required launch argument "need" was not provided.'),
        ('<include file="/no/such.launch.xml"/>', "does not exist: '/no/such.launch.xml'"),
        ('<include file="$(dirname)/it.launch.xml"/>', "does a file include itself?"),
        (
            '<include file="$(dirname)/x"><arg name="a" default="1"/></include>',
            "Attribute 'value' of type '<class 'str'>' not found in Entity 'arg'",
        ),
        (
            '<node pkg="fake" exec="node" respawn_delay="-1"/>',
            "Attribute respawn_delay of Entity node expected to be a non-negative value but got `-1`",
        ),
        ('<node pkg="fake" exec="node" respawn="maybe"/>', "Cannot convert value 'maybe' to 'bool'"),
        ('<node pkg="fake" exec="node" output="loud"/>', "loud is not a valid standard output config"),
    ],
    ids=lambda text: text[:100],
)
def test_what_is_wrong_is_refused_in_the_real_words_with_file_and_line(launch: Launch, body: str, message: str) -> None:
    with pytest.raises(LaunchError) as caught:
        launch(body)
    assert message in str(caught.value)
    assert "it.launch.xml:2: " in str(caught.value)


def test_the_line_is_that_of_the_innermost_place(launch: Launch) -> None:
    with pytest.raises(LaunchError, match=r"it\.launch\.xml:4: launch configuration 'zz' does not exist"):
        launch('<group>\n<node pkg="fake" exec="node">\n<param name="a" value="$(var zz)"/>\n</node>\n</group>')


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<launch>\n<arg", "xml:2: not well-formed XML"),
        ("", "not well-formed XML: no element"),
        ("<other/>", "'launch' as root"),
        *(
            (f'<?xml version="1.0" encoding="{name}"?>\n<launch/>', r"xml:1: (cannot be read|not well-formed XML): ")
            for name in ("utf-7", "utf-16", "utf-32", "no-such", "hex", "idna", "punycode", "shift_jis", "rot13")
        ),
    ],
)
def test_files_that_are_no_launch_files_are_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "broken.launch.xml"
    path.write_text(text)
    with pytest.raises(LaunchError, match=message):
        evaluate(path, {}, {}, tmp_path)
