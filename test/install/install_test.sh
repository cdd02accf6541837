#!/usr/bin/env bash
# install_test.sh BUILD PREFIX: installs into a folder of its own and runs a demo from there, with nothing of the source
# or devel space in reach: launch files, scenes, meshes, programs, messages, plugins.
set -euo pipefail
build="$1" prefix="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
DESTDIR="$folder" cmake --install "$build" >"$folder/install.log"
root="$folder$prefix"
unset ROS_ROOT CMAKE_PREFIX_PATH ROSLISP_PACKAGE_DIRECTORIES LD_LIBRARY_PATH PKG_CONFIG_PATH
# What setup.sh of the prefix would set, were it installed where it was configured for.
export CMAKE_PREFIX_PATH="$root${MESHLESS_CUTTING_ROS_PREFIX:+:$MESHLESS_CUTTING_ROS_PREFIX}"
export ROS_PACKAGE_PATH="$root/share${MESHLESS_CUTTING_ROS_PREFIX:+:$MESHLESS_CUTTING_ROS_PREFIX/share}"
python_path="$(find "$root/lib" -type d -path '*-packages/meshless_cutting' -printf '%h\n' -quit)"
export PYTHONPATH="$python_path${MESHLESS_CUTTING_ROS_PREFIX:+:$MESHLESS_CUTTING_ROS_PREFIX/lib/python3/dist-packages}"
cd "$folder"

[ "$(rospack find meshless_cutting)" = "$root/share/meshless_cutting" ] || { echo "the package is not found"; exit 1; }
for kind in rviz nodelet; do
  [[ "$(rospack plugins --attrib=plugin "$kind")" == *"$root/share/meshless_cutting/"* ]] || { echo "no $kind plugin"; exit 1; }
done

port=$((20000 + $$ % 20000))
export ROS_MASTER_URI="http://localhost:$port" ROS_HOSTNAME=localhost
share="$root/share/meshless_cutting"
# The block swings: the session begins with the stroke, or where the blade meets it would depend on who started when.
timeout 100 roslaunch -p "$port" meshless_cutting liver.launch start_with_samples:=true scene:="$share/launch/block.yaml" \
  strokes:="$share/launch/block_strokes.yaml" rviz:=false record:=true bag:="$folder/run.bag" end_with_strokes:=true \
  >"$folder/launch.log" 2>&1 || true
[ -s "$folder/run.bag" ] || { tail -n 30 "$folder/launch.log"; echo "no bag was recorded"; exit 1; }
rosrun meshless_cutting bag_report run.bag | tee report.log
grep -q 'fragments 1' report.log || { echo "expected one fragment"; exit 1; }
rosrun meshless_cutting replay --scene "package://meshless_cutting/launch/block.yaml" --input run.bag --output again.bag
echo "installed package: all well"
