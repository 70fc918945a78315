# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

# Sourced by ./acts and the Makefile: enters the environment of this checkout.
# With a ROS 2 installation sourced, that is the user's own workspace (colcon build); without one, what
# scripts/bootstrap.py has set up, which is done here when it is missing or out of date; ROS=jazzy chooses another
# distribution than Kilted for it.
acts_root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)

# Whether a sourced workspace holds ACTS.
acts_is_sourced() {
  local prefix
  local IFS=:
  for prefix in ${AMENT_PREFIX_PATH:-}; do
    if [ -d "$prefix/share/acts_tools" ]; then return 0; fi
  done
  return 1
}

# Before a program of Python that takes Ctrl-C when it can: while Python itself starts, it would show a traceback.
# Tried with another signal: a shell whose child does not end by Ctrl-C goes on.
acts_hold="env --block-signal=INT"
if ! env --block-signal=USR1 true 2>/dev/null; then acts_hold=; fi

if ! command -v ros2 >/dev/null 2>&1; then
  if ! command -v "${PYTHON:-python3}" >/dev/null; then
    echo "[setup] missing: ${PYTHON:-python3}. Install with: sudo apt-get install python3 python3-venv python3-dev" >&2
    exit 1
  fi
  $acts_hold "${PYTHON:-python3}" "$acts_root/scripts/bootstrap.py" --quiet ${PYTHON:+--this-python}
  acts_state="$acts_root/.acts"
  if [ "${ROS:-kilted}" != kilted ]; then acts_state="$acts_state/$ROS"; fi
  # shellcheck disable=SC1091
  source "$acts_state/env.sh"
elif ! acts_is_sourced; then
  if [ ! -f "$acts_root/install/setup.bash" ]; then
    echo "[setup] ROS 2 ${ROS_DISTRO:-} is sourced, but no workspace with ACTS in it. In the workspace's folder run:" >&2
    echo "[setup]   rosdep install --from-paths . --ignore-src -y && pip install -r $acts_root/requirements-ros.txt" >&2
    echo "[setup]   colcon build && source install/setup.bash" >&2
    exit 1
  fi
  set +u # setup files use variables that are not set
  # shellcheck disable=SC1091
  source "$acts_root/install/setup.bash"
  set -u
fi
