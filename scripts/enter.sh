# Sourced by ./acts and the Makefile: enters the environment of this checkout.
# With a ROS 2 installation sourced, that is the workspace's own overlay (colcon build); without one, what
# scripts/bootstrap.py has set up, which is done here when it is missing or out of date.
acts_root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
if command -v ros2 >/dev/null 2>&1; then
  if [ ! -f "$acts_root/install/setup.bash" ]; then
    echo "[setup] ROS 2 ${ROS_DISTRO:-} is sourced but the workspace is not built. Run in $acts_root:" >&2
    echo "[setup]   rosdep install --from-paths . --ignore-src -y && colcon build" >&2
    exit 1
  fi
  set +u
  # shellcheck disable=SC1091
  source "$acts_root/install/setup.bash"
  set -u
else
  "${PYTHON:-python3}" "$acts_root/scripts/bootstrap.py" --quiet
  # shellcheck disable=SC1091
  source "$acts_root/.acts/env.sh"
fi
