#!/usr/bin/env bash
# The liver demo: installs what is missing, builds, launches. With a display rviz opens; without one, or with --headless, it runs
# without, prints what was cut, and leaves results/liver.bag and results/liver.png (rviz in a virtual display).
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
headless=false
[ -n "${DISPLAY:-}" ] || headless=true
[ "${1:-}" = "--headless" ] && headless=true

install_build_dependencies
if $headless; then install "${SCREENSHOT_PACKAGES[@]}"; fi
build -DBUILD_TESTING=OFF
results="$SOURCE_DIR/results"
mkdir -p "$results"
bag="$results/liver.bag"
export ROS_MASTER_URI="${ROS_MASTER_URI:-http://localhost:11311}"

if ! $headless; then
  say "Liver demo in rviz; close it with Ctrl-C"
  exec roslaunch meshless_cutting liver.launch
fi

say "Running the strokes (about 15 s)"
rm -f "$bag" "$bag.active"
roslaunch meshless_cutting liver.launch rviz:=false record:=true bag:="$bag" end_with_strokes:=true \
  >"$results/liver.log" 2>&1 || true
[ -s "$bag" ] || { tail -n 20 "$results/liver.log" >&2; die "no bag was recorded; the log is $results/liver.log"; }
grep -E 'WARN|ERROR|FATAL' "$results/liver.log" | head -n 5 || true
"$SOURCE_DIR/scripts/demo_report.py" "$bag"

say "Rendering a picture in rviz (about 40 s)"
"$SOURCE_DIR/scripts/screenshot.sh" "$results/liver.png"
say "Done: $bag and $results/liver.png"
