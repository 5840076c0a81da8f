#!/usr/bin/env bash
# Builds this repository with colcon, as a workspace of ROS 2 does: the library from package.xml, and then the node in
# ros2/, which finds the library where colcon installed it. ROS 2 is not needed: ffi/tests/ros2_stand_in/ stands for
# its headers and packages, so this tests the packages, the types and what the node does, not ROS itself.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here"
say() { echo "colcon: $*"; }
fail() { echo "colcon: $*" >&2; exit 1; }
quiet() { "$@" >quiet.log 2>&1 || { cat quiet.log >&2; fail "failed: $*"; }; }

# ---- colcon itself, installed once
venv=$root/build/colcon
if ! cmp -s "$root/scripts/colcon.txt" "$venv/installed.txt"; then
    rm -rf "$venv"
    python3 -m venv "$venv"
    quiet "$venv/bin/pip" install --quiet --requirement "$root/scripts/colcon.txt"
    cp "$root/scripts/colcon.txt" "$venv/installed.txt"
fi
export PATH="$venv/bin:$PATH"

# ---- the workspace
checked="-fsanitize=address"
mkdir stand-in
for package in ament_cmake geometry_msgs nav_msgs rclcpp sensor_msgs shape_msgs std_msgs tf2_ros; do
    echo "include($root/ffi/tests/ros2_stand_in/cmake/stand-in.cmake)" >"stand-in/$package-config.cmake"
    packages+=" -D${package}_DIR=$here/stand-in"
done
# colcon looks for no packages inside of a package, so ros2/ is a path of its own.
paths="$root $root/ros2"
quiet colcon --log-base log list --topological-order --names-only --base-paths $paths
[ "$(cat quiet.log)" = "$(printf 'hangpose\nhangpose_ros')" ] || fail "colcon finds other packages: $(cat quiet.log)"
quiet colcon --log-base log build --base-paths $paths --event-handlers console_direct+ \
    --cmake-args -DHANGPOSE_CARGO_DIR="${CARGO_TARGET_DIR:-$root/target}/link" $packages \
    -DCMAKE_CXX_FLAGS="-Werror -g $checked"
prefix=$here/install/hangpose
[ -e "$prefix/include/hangpose/ros2.hpp" ] || fail "the package hangpose has no hangpose/ros2.hpp"
node=$here/install/hangpose_ros
[ -e "$node/share/hangpose_ros/config/hang_node.yaml" ] || fail "the package hangpose_ros has no configuration"
quiet "$node/lib/hangpose_ros/hang_node"
quiet python3 -m py_compile "$node/share/hangpose_ros/launch/hang_node.launch.py"
say "builds the packages hangpose and hangpose_ros"

# ---- the node, with messages
objects=$here/build/hangpose_ros/CMakeFiles/hang_node.dir/src
quiet g++ -std=c++17 -g $checked -Wall -Wextra -Wpedantic -Werror -I"$prefix/include" \
    -I"$root/ffi/tests/ros2_stand_in/include" -I"$root/ros2/src" "$root/ffi/tests/c/ros2_node.cpp" \
    "$objects"/{hang_node,settings,obj_file}.cpp.o "$prefix/lib/libhangpose.a" -o ros2_node
quiet ./ros2_node "$root/samples/mug.obj" "$root/samples/hook.obj"
# The test prints the parameters of the node. Each is described in the configuration.
while read -r name; do
    grep -qE "^ *(# )?${name##*.}:" "$root/ros2/config/hang_node.yaml" ||
        fail "the parameter $name is not in ros2/config/hang_node.yaml"
done <quiet.log
say "the node gives the poses and the path of the library, under ASan: $(wc -l <quiet.log) parameters"
