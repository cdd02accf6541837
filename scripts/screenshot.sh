#!/usr/bin/env bash
# screenshot.sh OUT.png [SECONDS] [LAUNCH_ARGUMENT...]: the liver demo in rviz under a virtual display, photographed SECONDS after
# the strokes began (default 12: both are done). Needs a built workspace (scripts/demo.sh builds it).
set -euo pipefail
out="$(realpath -m "$1")"
seconds="${2:-12}"
shift $(($# > 1 ? 2 : 1))
SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
export PATH="/usr/bin:$PATH" ROS_HOSTNAME="${ROS_HOSTNAME:-localhost}" LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1
set +u
# shellcheck disable=SC1091
source "$SOURCE_DIR/devel/setup.bash"
set -u
port=$((20000 + RANDOM % 10000))
export ROS_MASTER_URI="http://localhost:$port" XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"
display=":$((90 + RANDOM % 100))"
Xvfb "$display" -screen 0 1280x860x24 +extension GLX +render -noreset >/dev/null 2>&1 &
xvfb=$!
export DISPLAY="$display"
launch=
finish() {
  [ -z "$launch" ] || kill -INT "$launch" 2>/dev/null || true
  [ -z "$launch" ] || wait "$launch" 2>/dev/null || true
  kill "$xvfb" 2>/dev/null || true
}
trap finish EXIT
sleep 1
# rviz first, since it takes a while to draw; then the player starts the strokes.
roslaunch -p "$port" meshless_cutting liver.launch player:=false "$@" >/tmp/meshless_cutting_screenshot.log 2>&1 &
launch=$!
for _ in $(seq 60); do
  sleep 1
  [[ "$(xwininfo -root -tree 2>/dev/null)" == *RViz* ]] && break
done
sleep 8
timeout "$((seconds + 20))" rosrun meshless_cutting tool_player _path:="$SOURCE_DIR/launch/liver_strokes.yaml" \
  _topic:=/simulator/scalpel/measured_cp _rate:=500 >/dev/null 2>&1 &
sleep "$seconds"
import -window root "$out"
printf 'wrote %s\n' "$out"
