# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Arguments of launch files: which are needed, what they may be, and how they are listed, as in real ROS 2 launch."""

from __future__ import annotations

import os

import pytest
from fake_prefix import Launch, Prefix, words

from acts_core.errors import LaunchError
from acts_tools.launch.show import show_arguments

PARAM = '<node pkg="fake" exec="node"><param name="a" value="{}"/></node>'
FAR_TOO_LONG = (5000 * "9", f"0x{5000 * 'f'}", 3000 * "[")
NODE = '<node pkg="fake" exec="node" args="{}"/>'


def test_a_missing_required_argument_is_named_with_its_description(launch: Launch, prefix: Prefix) -> None:
    body = '<arg name="need" description="what it is for"/>'
    message = r"missing required argument 'need' \(description: 'what it is for'\), given: \[{}\]"
    with pytest.raises(LaunchError, match=message.format("")):
        launch(body)
    prefix.launch("needs.launch.xml", body)
    with pytest.raises(LaunchError, match=r"it\.launch\.xml:2: Included .*" + message.format("other")):
        launch('<include file="$(dirname)/needs.launch.xml"><arg name="other" value="1"/></include>')
    assert launch(body + NODE.format("$(var need)"), need="5").processes[0].command[1] == "5"


def test_arguments_are_listed_with_description_and_default_as_the_real_launch_does(prefix: Prefix) -> None:
    prefix.launch("inner.launch.xml", '<arg name="m" default="55" description="taxels"/><arg name="sim" default="0"/>')
    path = prefix.launch(
        "outer.launch.xml",
        """<arg name="sim" default="true" description="simulated or not"/>
        <arg name="need"/>
        <arg name="file" default="$(find-pkg-share fake)/$(var sim).yaml"/>
        <group if="$(var sim)"><include file="$(dirname)/inner.launch.xml"/></group>
        <include file="$(var file)"/>""",
    )
    assert show_arguments(path, os.environ) == (
        "Arguments (pass arguments as '<name>:=<value>'):\n\n"
        "    'sim':\n        simulated or not\n        (default: 'true')\n\n"
        "    'need':\n        no description given\n\n"
        "    'file':\n        no description given\n"
        "        (default: FindPackageShare(pkg='fake') + '/' + LaunchConfig('sim') + '.yaml')\n\n"
        "    'm':*\n        taxels\n        (default: '55')\n\n"
        "* argument(s) which are only used if specific conditions occur"
    )


CHOICE = '<arg name="colour" default="red" description="Of it"><choice value="red"/><choice value="blue"/></arg>'


def test_an_argument_with_choices_takes_no_other(launch: Launch, prefix: Prefix) -> None:
    body = CHOICE + NODE.format("$(var colour)")
    assert words(launch(body))[0][0] == "red"
    assert words(launch(body, colour="blue"))[0][0] == "blue"
    wrong = r"Argument \"colour\" provided value \"bleu\" is not valid\. Valid options are: \['red', 'blue'\]"
    with pytest.raises(LaunchError, match=wrong):
        launch(body, colour="bleu")
    # Also where the default is none of them, and where a file that includes this one gives it.
    with pytest.raises(LaunchError, match="not valid"):
        launch(body.replace('default="red"', 'default="green"'))
    prefix.launch("inner.launch.xml", CHOICE)
    with pytest.raises(LaunchError, match="not valid"):
        launch('<include file="$(dirname)/inner.launch.xml"><arg name="colour" value="bleu"/></include>')


def test_choices_are_listed_as_the_real_launch_does(prefix: Prefix) -> None:
    bare = '<arg name="size"><choice value="1"/></arg>'
    shown = show_arguments(prefix.launch("it.launch.xml", CHOICE + bare), os.environ)
    assert "Of it. Valid choices are: ['red', 'blue']" in shown
    assert "One of: ['1']" in shown
