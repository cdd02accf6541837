#!/usr/bin/env bash
# figures.sh [NAME...]: the figures of the paper, docs/figures/NAME.png, photographed in rviz under a virtual display (default: all).
# Needs a built workspace (scripts/demo.sh builds it) and Xvfb, xwininfo, ImageMagick.
# Simulated time is driven from here and stopped at the moment of the picture, so that no picture depends on the speed of the machine.
set -euo pipefail
SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

# name, after @ the moment where a figure has several | simulated time of the picture, s | focal point, m | distance, m | pitch, rad | yaw, rad | height of the grid, m | what is shown
VIEWS="
situation_1|0.42|{X: 0.035, Y: 0.01, Z: -0.535}|0.25|0.22|5.0|-0.6|object
situation_2|0.333|{X: 0.06, Y: 0.01, Z: -0.465}|0.24|0.20|4.9|-0.6|object
situation_3|0.30|{X: 0.025, Y: 0.01, Z: -0.08}|0.20|0.35|5.0|-0.12|fragments
fig7_falling_cylinder|0.30|{X: 0, Y: 0, Z: -0.09}|0.32|0.30|5.9|-0.16|fragments
fig8_rising_edge|0.30|{X: 0, Y: 0, Z: 0.005}|0.22|0.30|5.9|-0.06|fragments
fig9_twisting_blade|1.05|{X: 0.05, Y: 0.02, Z: 0.015}|0.20|0.55|4.9|0|object
fig10_brain@start|1.5|{X: -0.005, Y: 0.0, Z: 0.0}|0.33|0.75|0.75|-0.037|object
fig10_brain|3.0|{X: -0.005, Y: 0.0, Z: 0.0}|0.33|0.75|0.75|-0.037|object
fig10_brain@end|5.0|{X: -0.005, Y: 0.0, Z: 0.0}|0.33|0.75|0.75|-0.037|object
fig11_liver|5.6|{X: 0.0, Y: 0.0, Z: -0.03}|0.31|0.6|5.0|-0.1|object
fig12_mapping|1.1|{X: 0.055, Y: 0.01, Z: -0.03}|0.20|0.30|5.0|-0.1|mapping
"

export PATH="/usr/bin:$PATH" ROS_HOSTNAME="${ROS_HOSTNAME:-localhost}" LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"
set +u
# shellcheck disable=SC1091
source "$SOURCE_DIR/devel/setup.bash"
set -u
work="$(mktemp -d)"
started=()
stop_all() {
  for ((i = ${#started[@]} - 1; i >= 0; --i)); do
    kill -INT "${started[i]}" 2>/dev/null || true
    for _ in $(seq 20); do
      kill -0 "${started[i]}" 2>/dev/null || break
      sleep 0.25
    done
    kill -KILL "${started[i]}" 2>/dev/null || true
  done
  wait 2>/dev/null || true
  started=()
}
trap 'stop_all; rm -rf "$work"' EXIT

start() {
  setsid "$@" >>"$work/log" 2>&1 &
  started+=($!)
  disown
}

# The clock stands at 100 s until the file "go" appears, runs for the given time and stands again. From its first frame on it waits
# for the simulator, which begins with the tool's first sample: no more than three frames of 1/60 s farther ahead than then.
cat >"$work/clock.py" <<'PYTHON'
import os, sys, time
import rospy
from rosgraph_msgs.msg import Clock
seconds, go = float(sys.argv[1]), sys.argv[2]
rospy.init_node('clock', disable_rostime=True)
publisher = rospy.Publisher('/clock', Clock, queue_size=10)
frames = []
rospy.Subscriber('/simulator/statistics', rospy.AnyMsg, frames.append)
step, now, waited, began = 0.002, 0.0, 0, None
while not rospy.is_shutdown():
    publisher.publish(Clock(rospy.Time.from_sec(100 + now)))
    time.sleep(0.004)
    if not os.path.exists(go):
        frames.clear()
        began = None
    elif frames and began is None:
        began = now
    elif began is not None and len(frames) < 60 * (now - began) - 3 and waited < 1000:
        waited += 1
    elif now < seconds:
        now, waited = now + step, 0
    elif not os.path.exists(go + '.done'):
        print(len(frames), 'frames in', now, 's', flush=True)
        open(go + '.done', 'w').close()
PYTHON

picture() {
  local name="$1" seconds="$2" focus="$3" distance="$4" pitch="$5" yaw="$6" grid="$7" kind="$8"
  local figure="${name%@*}" out="$SOURCE_DIR/docs/figures/${name/@/_}.png" port=$((20000 + RANDOM % 10000)) display=":$((90 + RANDOM % 100))"
  rm -f "$work"/go*
  # The shipped displays, seen from elsewhere; the panels are cropped. The lines of the mapping lie inside: without the skin.
  local displays="$SOURCE_DIR/launch/demo.rviz"
  [ "$kind" != mapping ] || displays="$SOURCE_DIR/launch/mapping.rviz"
  sed -E -e "s/^( *Focal Point: ).*/\1$focus/" -e "s/^( *Distance: ).*/\1$distance/" -e "s/^( *Pitch: ).*/\1$pitch/" \
    -e "s/^( *Yaw: ).*/\1$yaw/" -e "s/^( *Offset: ).*/\1{X: 0, Y: 0, Z: $grid}/" "$displays" >"$work/view.rviz"
  if [ "$kind" = mapping ]; then
    sed -i -E -e '/Name: Tissue/,/Topology Topic/s/^( *(Enabled|Value): )true/\1false/' \
      -e '/Name: Tools/,/Namespaces/s/Namespaces: .*/Namespaces: {held: false}/' "$work/view.rviz"
  fi
  sed -i -E "s/^( *Frame Rate: ).*/\15/" "$work/view.rviz" # drawing without a graphics processor leaves little for the rest
  [ "$kind" != fragments ] || sed -i -E 's/^( *Colours: ).*/\1Fragments/' "$work/view.rviz"
  start Xvfb "$display" -screen 0 1280x860x24 +extension GLX +render -noreset
  export ROS_MASTER_URI="http://localhost:$port" DISPLAY="$display"
  start roscore -p "$port"
  until rosparam set /use_sim_time true 2>/dev/null; do sleep 0.5; done
  start python3 "$work/clock.py" "$seconds" "$work/go"
  start roslaunch -p "$port" meshless_cutting figure.launch "figure:=$figure" player:=false rviz:=false
  start rviz -d "$work/view.rviz"
  for _ in $(seq 120); do
    [[ "$(rostopic list 2>/dev/null)" == */simulator/surface/positions* && "$(xwininfo -root -tree 2>/dev/null)" == *RViz* ]] && break
    sleep 1
  done
  sleep 6
  # The path begins when its player does, while the clock stands.
  local strokes="$SOURCE_DIR/launch/scenes/${figure}_strokes.yaml"
  if [ -e "$strokes" ]; then
    start rosrun meshless_cutting tool_player "_path:=$strokes" _topic:=/simulator/blade/measured_cp _rate:=500
    sleep 3
  fi
  touch "$work/go"
  until [ -e "$work/go.done" ]; do sleep 0.5; done
  sleep 4
  import -window root "$work/$name.png"
  stop_all
  mkdir -p "$(dirname "$out")"
  convert "$work/$name.png" -crop 890x700+366+75 +repage "$work/small.png"
  if command -v pngquant >/dev/null; then
    pngquant --force --output "$out" 96 "$work/small.png"
  else
    convert "$work/small.png" -colors 96 "PNG8:$out"
  fi
  printf 'wrote %s, %s bytes\n' "$out" "$(stat -c %s "$out")"
}

while IFS='|' read -r name seconds focus distance pitch yaw grid kind <&3; do
  [ -n "$name" ] || continue
  if [ $# -gt 0 ] && [[ " $* " != *" ${name%@*} "* ]]; then continue; fi
  picture "$name" "$seconds" "$focus" "$distance" "$pitch" "$yaw" "$grid" "$kind"
done 3<<<"$VIEWS"
