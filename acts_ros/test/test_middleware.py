# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is asked of the middleware, and that it complies. ROS_DOMAIN_ID 201."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import rclpy
from rclpy.impl.implementation_singleton import rclpy_implementation

from acts_core.errors import SettingsError
from acts_ros.middleware import check_domain, choose_transports, telling_wrong_arguments
from acts_ros.processes import packages

PROFILE, JAZZY_PROFILE = PROFILES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")
FILES = ("DEFAULT_FASTDDS_PROFILES.xml", "DEFAULT_FASTRTPS_PROFILES.xml")
FAST_DDS = "rmw_fastrtps_cpp"

THREADS = """
import rclpy
from pathlib import Path
from acts_ros import middleware
middleware.init()
node = rclpy.create_node("threads")
for thread in Path("/proc/self/task").iterdir():
    print((thread / "comm").read_text().strip())
"""
SHARED_MEMORY = """
import rclpy
from pathlib import Path
from acts_ros import middleware
middleware.init()
node = rclpy.create_node("publisher")
print(any("/dev/shm/fast" in line for line in Path("/proc/self/maps").read_text().splitlines()))
rclpy.shutdown()
"""


def environment(**variables: str) -> dict[str, str]:
    return {"AMENT_PREFIX_PATH": os.environ["AMENT_PREFIX_PATH"], "ROS_DISTRO": "kilted", **variables}


def profile(name: str) -> str:
    return str(packages.share("acts_config", environment()) / "network" / f"{name}.xml")


@pytest.mark.parametrize("asked", [{"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, {"ROS_LOCALHOST_ONLY": "1"}])
def test_this_machine_only_takes_our_profile_and_nothing_beside_it(asked: dict[str, str], tmp_path: Path) -> None:
    variables = environment(**asked)
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert "127.0.0.1" in Path(variables[PROFILE]).read_text()
    assert JAZZY_PROFILE not in variables
    # With LOCALHOST rmw_fastrtps opens a socket on all interfaces beside those of the profile.
    assert variables["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SYSTEM_DEFAULT"
    assert "ROS_LOCALHOST_ONLY" not in variables


@pytest.mark.parametrize(
    "asked",
    [
        {},
        {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"},
        {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"},
        {"ROS_LOCALHOST_ONLY": "0"},
    ],
)
def test_the_network_stays_open_where_that_is_asked_for(asked: dict[str, str], tmp_path: Path) -> None:
    variables = environment(**asked)
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert variables.pop(PROFILE) == profile("open")
    assert variables == environment(**asked, FASTDDS_BUILTIN_TRANSPORTS="UDPv4")


def test_what_is_started_by_a_process_that_is_bound_may_be_open(tmp_path: Path) -> None:
    bound = environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    choose_transports(bound, FAST_DDS, tmp_path)
    inherited = dict(bound)
    assert choose_transports(inherited, FAST_DDS, tmp_path) is None
    assert inherited[PROFILE] == bound[PROFILE]
    assert (
        choose_transports(again := {**bound, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, FAST_DDS, tmp_path) is None
    )
    assert again == bound
    assert choose_transports(opened := {**bound, "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, FAST_DDS, tmp_path) is None
    assert opened[PROFILE] == profile("open")


def test_what_is_started_by_a_process_that_is_open_may_be_bound(tmp_path: Path) -> None:
    opened = environment()
    choose_transports(opened, FAST_DDS, tmp_path)
    inherited = dict(opened)
    assert choose_transports(inherited, FAST_DDS, tmp_path) is None
    assert inherited == opened
    assert (
        choose_transports(bound := {**opened, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, FAST_DDS, tmp_path) is None
    )
    assert bound[PROFILE] == profile("loopback")


def test_transports_that_the_user_has_chosen_stay(tmp_path: Path) -> None:
    asked = environment(FASTDDS_BUILTIN_TRANSPORTS="LARGE_DATA")
    variables = dict(asked)
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert variables.pop(PROFILE) == profile("open")
    assert variables == asked


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_that_the_user_has_chosen_stays_on_an_open_network(name: str, tmp_path: Path) -> None:
    asked = environment(**{name: "mine"})
    variables = dict(asked)
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert variables == {**asked, "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4"}


@pytest.mark.parametrize("name", FILES)
def test_a_profile_in_the_folder_stays_on_an_open_network(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("<dds/>")
    variables = environment()
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert not set(PROFILES) & set(variables)


@pytest.mark.parametrize("name", ["ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER"])
def test_machines_that_the_user_names_are_looked_for_with_our_profile(name: str, tmp_path: Path) -> None:
    asked = environment(**{name: "192.168.1.20"})
    variables = dict(asked)
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert variables.pop(PROFILE) == profile("open")
    assert variables == {**asked, "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4"}


@pytest.mark.parametrize("name", [*PROFILES, "ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER"])
def test_what_the_user_has_set_stays_and_is_told(name: str, tmp_path: Path) -> None:
    asked = environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST", **{name: "mine"})
    variables = dict(asked)
    told = choose_transports(variables, FAST_DDS, tmp_path)
    assert told is not None
    assert name in told
    assert variables == asked


@pytest.mark.parametrize("name", FILES)
def test_a_profile_in_the_folder_stays_and_is_told(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("<dds/>")
    variables = environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    told = choose_transports(variables, FAST_DDS, tmp_path)
    assert told is not None
    assert name in told
    assert not set(PROFILES) & set(variables)


def test_another_middleware_is_left_alone_and_told(tmp_path: Path) -> None:
    asked = environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST", CYCLONEDDS_URI="mine")
    variables = dict(asked)
    told = choose_transports(variables, "rmw_cyclonedds_cpp", tmp_path)
    assert told is not None
    assert "rmw_cyclonedds_cpp" in told
    assert variables == asked
    # Where nothing is asked of it, there is nothing to tell.
    assert choose_transports(environment(), "rmw_cyclonedds_cpp", tmp_path) is None


def test_every_flavour_of_fast_dds_takes_our_profile(tmp_path: Path) -> None:
    variables = environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
    assert choose_transports(variables, "rmw_fastrtps_dynamic_cpp", tmp_path) is None
    assert variables[PROFILE] == profile("loopback")


@pytest.mark.parametrize(("asked", "wanted"), [("LOCALHOST", "loopback"), ("SUBNET", "open")])
def test_jazzy_reads_the_profile_by_its_older_name(asked: str, wanted: str, tmp_path: Path) -> None:
    variables = environment(ROS_AUTOMATIC_DISCOVERY_RANGE=asked, ROS_DISTRO="jazzy")
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert variables[JAZZY_PROFILE] == profile(wanted)
    assert PROFILE not in variables


def test_humble_is_asked_in_its_own_way(tmp_path: Path) -> None:
    variables = environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST", ROS_DISTRO="humble")
    assert choose_transports(variables, FAST_DDS, tmp_path) is None
    assert variables["ROS_LOCALHOST_ONLY"] == "1"
    assert not set(PROFILES) & set(variables)
    opened = environment(ROS_DISTRO="humble")
    assert choose_transports(opened, FAST_DDS, tmp_path) is None
    assert not set(PROFILES) & set(opened)


@pytest.mark.parametrize("discovery", ["LOCALHOST", "SUBNET"])
def test_no_process_waits_for_another_in_shared_memory(discovery: str) -> None:
    if not rclpy.get_rmw_implementation_identifier().startswith("rmw_fastrtps"):
        pytest.skip("only Fast DDS has it")
    finished = subprocess.run(
        [sys.executable, "-c", SHARED_MEMORY],
        env={**os.environ, "ROS_DOMAIN_ID": "201", "ROS_AUTOMATIC_DISCOVERY_RANGE": discovery},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert finished.stdout.strip() == "False", finished.stderr


@pytest.mark.parametrize("discovery", ["LOCALHOST", "SUBNET"])
def test_no_thread_of_a_process_asks_for_descriptions_of_types(discovery: str) -> None:
    finished = subprocess.run(
        [sys.executable, "-c", THREADS],
        env={**os.environ, "ROS_DOMAIN_ID": "201", "ROS_AUTOMATIC_DISCOVERY_RANGE": discovery},
        capture_output=True,
        text=True,
        timeout=60,
    )
    names = finished.stdout.split()
    assert [name for name in names if name.startswith("python")], finished.stderr
    assert [name for name in names if name.startswith("dds.tls")] == []


@pytest.mark.parametrize("domain", ["233", "-1", "abc", "4294967297", "1.5"])
def test_a_domain_that_there_cannot_be_is_refused_with_those_there_are(domain: str) -> None:
    with pytest.raises(SettingsError, match=f"ROS_DOMAIN_ID={domain}: allowed is 0 to 232"):
        check_domain({"ROS_DOMAIN_ID": domain})


@pytest.mark.parametrize("variables", [{}, {"ROS_DOMAIN_ID": ""}, {"ROS_DOMAIN_ID": "0"}, {"ROS_DOMAIN_ID": "232"}])
def test_a_domain_that_there_is_is_taken(variables: dict[str, str]) -> None:
    check_domain(variables)


def refusal_with_keys(folder: str) -> str:
    """What ROS is refused with where there must be keys, of this folder."""
    asked = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_STRATEGY": "Enforce", "ROS_SECURITY_KEYSTORE": folder}
    result = subprocess.run(
        [sys.executable, "-c", "from acts_ros import middleware; middleware.init()"],
        env={**os.environ, "ROS_DOMAIN_ID": "201", **asked},
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    return result.stderr.strip().splitlines()[-1]


def test_keys_that_are_asked_for_and_not_there_are_told_with_what_to_do(tmp_path: Path) -> None:
    told = refusal_with_keys(str(tmp_path))
    assert told.startswith("acts_core.errors.SettingsError: ROS: failed to initialize rcl: SECURITY ERROR: ")
    assert told.endswith("; make the keys of this enclave with `ros2 security`, or unset ROS_SECURITY_ENABLE")


def test_a_folder_of_keys_that_is_not_given_is_told_with_what_to_do() -> None:
    told = refusal_with_keys("")
    assert told.startswith("acts_core.errors.SettingsError: ROS: failed to initialize rcl: ")
    assert "; set ROS_SECURITY_KEYSTORE, which ROS_SECURITY_STRATEGY=Enforce needs, or unset" in told


@pytest.mark.parametrize(
    "variables",
    [
        {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_STRATEGY": "Permissive"},
        {"ROS_SECURITY_ENABLE": "false", "ROS_SECURITY_STRATEGY": "Enforce"},
    ],
)
def test_another_refusal_of_ros_stays_as_it_is(variables: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_SECURITY_KEYSTORE", raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    with pytest.raises(rclpy_implementation.RCLError, match=r"^failed to initialize rcl$"), telling_wrong_arguments([]):
        raise rclpy_implementation.RCLError("failed to initialize rcl")


def begin(**variables: str) -> str:
    """What a process says that begins with ROS in this environment, and nothing else."""
    result = subprocess.run(
        [sys.executable, "-c", "from acts_ros import middleware; middleware.init()"],
        env={**os.environ, "ROS_DOMAIN_ID": "201", **variables},
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    return result.stderr.strip()


def test_where_this_machine_alone_cannot_be_had_that_is_told() -> None:
    told = begin(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST", ROS_STATIC_PEERS="127.0.0.2")
    assert told.endswith(
        "[acts_ros]: ROS_AUTOMATIC_DISCOVERY_RANGE asks for this machine only, but ROS_STATIC_PEERS is there and is "
        "left as it is: others may get in (docs/security.md)"
    )
    assert begin(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST") == ""


def test_a_domain_that_there_cannot_be_is_refused_before_ros_begins() -> None:
    told = begin(ROS_DOMAIN_ID="233").splitlines()[-1]
    assert told.startswith("acts_core.errors.SettingsError: ROS_DOMAIN_ID=233: allowed is 0 to 232")


def test_ros_starts_in_a_folder_that_was_removed(tmp_path: Path) -> None:
    (tmp_path / "gone").mkdir()
    # In a file, as programs are: of -c, Python 3.13.0 itself looks for modules in the folder, and fails.
    program = tmp_path / "program.py"
    program.write_text("import os; os.rmdir(os.getcwd())\nfrom acts_ros import middleware; middleware.init()")
    result = subprocess.run(
        [sys.executable, program],
        cwd=tmp_path / "gone",
        env={**os.environ, "ROS_DOMAIN_ID": "201"},
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert (result.returncode, "Traceback" in result.stderr) == (0, False), result.stderr


def test_a_log_that_cannot_be_written_is_told_with_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    result = subprocess.run(
        [sys.executable, "-c", "from acts_ros import middleware; middleware.init()"],
        env={**os.environ, "ROS_LOG_DIR": str(tmp_path / "file" / "log")},
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    told = result.stderr.strip().splitlines()[-1]
    assert told.startswith("acts_core.errors.SettingsError: ROS: failed to initialize logging")
    assert told.endswith("; set ROS_LOG_DIR to a folder that can be written")
