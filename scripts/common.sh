# Sourced by demo.sh and test.sh: installs what is missing, builds, sets up the environment.
# shellcheck shell=bash
set -euo pipefail
SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD_DIR="$SOURCE_DIR/build"
export PATH="/usr/bin:$PATH" # ROS needs the system's python3, not one of pyenv or conda
export ROSCONSOLE_STDOUT_LINE_BUFFERED=1
export ROS_HOSTNAME="${ROS_HOSTNAME:-localhost}"

say() { printf '\n\033[1m== %s\033[0m\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Debian 12 has ROS 1 in its own archive; Ubuntu 20.04 gets it from packages.ros.org as Noetic.
DEBIAN_PACKAGES=(
  build-essential cmake pkg-config
  libassimp-dev libbenchmark-dev libboost-dev libbz2-dev libeigen3-dev libgtest-dev libyaml-cpp-dev zlib1g-dev
  libdiagnostic-updater-dev libdynamic-reconfigure-config-init-mutex-dev libgeometry-msgs-dev libinteractive-markers-dev libnodeletlib-dev libnodeletlib-tools
  librosbag-dev libroscpp-dev libroslib-dev librostest-dev librviz-dev libsensor-msgs-dev libstd-srvs-dev libtf2-msgs-dev libtf2-ros-dev libtopic-tools-dev
  liburdf-dev libvisualization-msgs-dev pluginlib-dev
  ros-message-generation ros-diagnostic-msgs ros-geometry-msgs ros-rosgraph-msgs ros-sensor-msgs ros-std-msgs ros-std-srvs
  ros-tf2-msgs ros-visualization-msgs
  rosbash rosout rospack-tools tf2-tools
  python3-numpy python3-rosbag python3-roslaunch python3-rosmsg python3-rosnode python3-rosservice python3-rostest
  python3-rostopic python3-sensor-msgs python3-std-srvs python3-visualization-msgs ros-robot-state-publisher
  catkin-lint python3-dynamic-reconfigure python3-matplotlib rviz)
NOETIC_PACKAGES=(
  build-essential cmake pkg-config
  libassimp-dev libbenchmark-dev libboost-dev libbz2-dev libeigen3-dev libgtest-dev libyaml-cpp-dev zlib1g-dev python3-numpy
  ros-noetic-diagnostic-updater ros-noetic-geometry-msgs ros-noetic-interactive-markers ros-noetic-message-generation
  ros-noetic-message-runtime ros-noetic-nodelet ros-noetic-pluginlib ros-noetic-robot-state-publisher ros-noetic-rosbag
  ros-noetic-rosbag-storage ros-noetic-roscpp ros-noetic-rosgraph-msgs ros-noetic-roslaunch ros-noetic-roslib
  ros-noetic-roslz4 ros-noetic-rosbash ros-noetic-rosmsg ros-noetic-rosnode ros-noetic-rosservice ros-noetic-rostest
  ros-noetic-rostopic ros-noetic-sensor-msgs ros-noetic-std-msgs ros-noetic-std-srvs ros-noetic-tf2 ros-noetic-tf2-msgs
  ros-noetic-tf2-ros ros-noetic-topic-tools ros-noetic-urdf ros-noetic-visualization-msgs
  ros-noetic-dynamic-reconfigure ros-noetic-rviz python3-catkin-lint python3-matplotlib)
SCREENSHOT_PACKAGES=(xvfb xauth imagemagick libgl1-mesa-dri x11-utils)

is_noetic() { [ -r /etc/os-release ] && grep -q 'VERSION_CODENAME=focal' /etc/os-release; }

# install PACKAGE...: what is not there yet, through apt.
install() {
  command -v apt-get >/dev/null || die "apt-get not found: expected Debian 12 or Ubuntu 20.04"
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}\n' "$package" 2>/dev/null | grep -q '^install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  say "Installing ${#missing[@]} packages: ${missing[*]}"
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      die "these packages are missing and neither root nor sudo is at hand; as root run: apt-get install ${missing[*]}"
    sudo=(sudo)
  fi
  if is_noetic && ! apt-cache show ros-noetic-roscpp >/dev/null 2>&1; then
    die "ROS Noetic's package source is not set up; follow wiki.ros.org/noetic/Installation/Ubuntu, then run this again"
  fi
  "${sudo[@]}" apt-get update -q
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}

install_build_dependencies() {
  if is_noetic; then install "${NOETIC_PACKAGES[@]}"; else install "${DEBIAN_PACKAGES[@]}"; fi
}

# use FILE: sources it; a setup file of catkin would take this function's arguments for its own.
use() {
  local file="$1"
  shift
  set +u
  # shellcheck disable=SC1090
  source "$file"
  set -u
}

# build [CMAKE_ARGUMENT...]
build() {
  if is_noetic; then use /opt/ros/noetic/setup.bash; fi
  say "Building"
  cmake -S "$SOURCE_DIR" -B "$BUILD_DIR" -DCMAKE_INSTALL_PREFIX="$SOURCE_DIR/install" "$@"
  cmake --build "$BUILD_DIR" -j"$(nproc)"
  use "$SOURCE_DIR/devel/setup.bash"
}
