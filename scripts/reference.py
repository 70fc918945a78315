# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Write docs/reference.md: every launch argument, node parameter and sampling scheme, from the sources.

Writes the choices of the arguments `scheme`, `method`, `protocol` and `robot`, and the names of the reflexes, into the
launch files, too: XML takes them from no registry.
"""

from __future__ import annotations

import argparse
import importlib
import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from pathlib import Path

from acts_control.hand.reflexes import REFLEXES
from acts_control.robots import ROBOTS
from acts_core.sampling import SCHEME_NUMBERS, SCHEMES
from acts_core.settings import Changeable, default_of, describe
from acts_driver.protocols import PROTOCOLS
from acts_recon.methods import METHODS

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "reference.md"

NODES = (
    ("acts_driver", "driver", "acts_driver.settings", "DriverSettings"),
    ("acts_recon", "reconstruction", "acts_recon.settings", "ReconstructionSettings"),
    ("acts_recon", "gait", "acts_recon.nodes.gait_node", "GaitSettings"),
    ("acts_control", "ball_state", "acts_control.ball.nodes.ball_state_node", "BallStateSettings"),
    ("acts_control", "ball_trajectory", "acts_control.ball.nodes.ball_trajectory_node", "BallTrajectorySettings"),
    ("acts_control", "ball_control", "acts_control.ball.nodes.ball_control_node", "BallControlSettings"),
    ("acts_control", "hand", "acts_control.hand.nodes.hand_node", "HandSettings"),
    ("acts_control", "hand_reflexes", "acts_control.hand.nodes.reflexes_node", "HandReflexesSettings"),
    ("acts_skins", "skin_contacts", "acts_skins.contacts.node", "SkinContactsSettings"),
    ("acts_skins", "skin_diagnostics", "acts_skins.overview.diagnostics_node", "SkinDiagnosticsSettings"),
    ("acts_skins", "skin_frames", "acts_skins.overview.frames_node", "SkinFramesSettings"),
    ("acts_view", "view", "acts_view.settings", "ViewSettings"),
    ("acts_sim", "ball_world", "acts_sim.ball.ball_world_node", "BallWorldSettings"),
)
"""Package, executable, module and settings class of every node with parameters."""

CHOICES: dict[str, Iterable[str]] = {
    "scheme": SCHEME_NUMBERS,
    "method": METHODS,
    "protocol": PROTOCOLS,
    "robot": ROBOTS,
}
"""What is registered, by the launch argument that chooses among it."""

LISTED: dict[str, Iterable[str]] = {"reflexes": REFLEXES}
"""What is registered, by the launch argument whose description lists it: it takes several of them."""

HEAD = """# Reference: launch arguments and parameters

Written by `./acts run python3 scripts/reference.py` from the launch files, settings classes and sampling schemes; a
test compares them.
"""


CHANGE = {Changeable.AT_START: "", Changeable.UNCONFIGURED: "unconfigured", Changeable.RUNNING: "running"}

CHANGE_IN_WORDS = """\
The column *change* says when a parameter can be set with `acts param` or `ros2 param set`: *running*: at any time, in
force from the next step or frame on; *unconfigured*: while the node's life cycle is in that state, before it is
configured or after cleanup; empty: only at the node's start. Any other change is refused with the reason, and nothing
changes then.
"""


def cell(text: object) -> str:
    return str(text).replace("|", "\\|")


def launch_section(name: str, launch_file: str) -> list[str]:
    lines = [f"### {name}", "", "| argument | default | |", "|---|---|---|"]
    for argument in ET.fromstring(launch_file).iter("arg"):
        # An arg tag with a value belongs to an include.
        if "value" not in argument.attrib:
            default = argument.get("default")
            shown = "required" if default is None else f"`{default}`"
            lines.append(f"| `{argument.get('name')}` | {cell(shown)} | {cell(argument.get('description', ''))} |")
    return [*lines, ""]


def shown_default(value: object) -> str:
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, float):
        return f"`{value:g}`"
    if isinstance(value, tuple):
        return "`[" + ", ".join(f"{item:.4g}" if isinstance(item, float) else str(item) for item in value) + "]`"
    return f"`{value}`" if value != "" else "empty"


def node_section(package: str, executable: str, module: str, class_name: str) -> list[str]:
    settings_class = getattr(importlib.import_module(module), class_name)
    lines = [f"### {package} {executable}", "", "| parameter | default | allowed | change | |", "|---|---|---|---|---|"]
    for name, info in describe(settings_class).items():
        default = shown_default(default_of(settings_class, name))
        cells = (f"`{name}`", default, info.allowed, CHANGE[info.changeable], info.description)
        lines.append(f"| {' | '.join(map(cell, cells))} |")
    return [*lines, ""]


def schemes_section() -> list[str]:
    lines = ["## Sampling schemes", "", "| scheme | number | a frame is | own settings |", "|---|---|---|---|"]
    for name, scheme in SCHEMES.items():
        own = "; ".join(
            f"`{setting.parameter}` ({setting.parameter_default:g}): {setting.parameter_description}"
            for setting in scheme.own_settings
        )
        number = scheme.number or "none: in Python only"
        lines.append(f"| `{name}` | {number} | {cell(scheme.description)} | {cell(own)} |")
    return [*lines, ""]


def with_choices(launch_file: str) -> str:
    """The text of a launch file, with all that is registered where it is chosen."""
    for argument, registered in CHOICES.items():

        def written(found: re.Match[str], names: Iterable[str] = registered) -> str:
            more = ["params_file"] if 'default="params_file"' in found[1] else []
            choices = "".join(f'<choice value="{name}"/>' for name in [*names, *more])
            return f"{found[1]}\n    {choices}\n{found[2]}"

        tag = rf'(<arg name="{argument}" default=[^>]*[^/]>)\n.*?\n(  </arg>)'
        launch_file = re.sub(tag, written, launch_file, flags=re.DOTALL)
    for argument, registered in LISTED.items():
        names = ", ".join(registered)
        launch_file = re.sub(rf'(<arg name="{argument}" [^>]*between: )[^;"]*', rf"\g<1>{names}", launch_file)
    return launch_file


def written_files() -> dict[Path, str]:
    """What this script writes, by path."""
    launch_files = {path: with_choices(path.read_text()) for path in sorted((ROOT / "launch").glob("*.launch.xml"))}
    return {**launch_files, PAGE: page(launch_files)}


def page(launch_files: Mapping[Path, str]) -> str:
    lines = [HEAD, "## Launch files of acts_bringup", ""]
    for path, text in launch_files.items():
        lines += launch_section(path.name, text)
    lines += ["## Parameters of the nodes", "", CHANGE_IN_WORDS]
    for node in NODES:
        lines += node_section(*node)
    lines += schemes_section()
    return "\n".join(lines).rstrip() + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="only say whether the page is up to date")
    arguments = parser.parse_args()
    stale = {path: text for path, text in written_files().items() if not path.is_file() or path.read_text() != text}
    for path, text in stale.items():
        if arguments.check:
            print(f"{path.relative_to(ROOT)} is out of date: ./acts run python3 scripts/reference.py", file=sys.stderr)
        else:
            path.write_text(text)
    return 1 if arguments.check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
