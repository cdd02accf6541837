#!/usr/bin/env bash
# Builds the simulation library and its tests with a sanitizer, apart from other builds, and runs them:
#   scripts/sanitize.sh address   AddressSanitizer and UndefinedBehaviorSanitizer: crossings, cutting, dynamics, a share of
#                                 the random strokes
#   scripts/sanitize.sh thread    ThreadSanitizer: the thread pool, and a block that is cut and falls, on several threads
# Any report ends the run with an error. An hour on two cores, most of it for the compiler.
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case "${1:-}" in
  address)
    flags="-fsanitize=address,undefined -fno-sanitize-recover=all"
    targets=(crossing_test cut_test cut_search tool_test boundary_test dynamics_test)
    ;;
  thread)
    flags="-fsanitize=thread"
    targets=(dynamics_test scenes_test)
    ;;
  *)
    echo "usage: scripts/sanitize.sh address|thread" >&2
    exit 2
    ;;
esac
install_build_dependencies
BUILD_DIR="$SOURCE_DIR/build-$1"
cmake -S "$SOURCE_DIR" -B "$BUILD_DIR" -DCATKIN_DEVEL_PREFIX="$BUILD_DIR/devel" -DBUILD_TESTING=ON \
  -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="-O1 -g1 $flags"
cmake --build "$BUILD_DIR" -j"$(nproc)" --target "${targets[@]}"
export TSAN_OPTIONS=halt_on_error=1
for target in "${targets[@]}"; do
  say "$target"
  arguments=()
  if [ "$target" = cut_search ]; then arguments=(--strokes 288); fi
  # Small bodies: packed loads are some hundred times slower when each is traced.
  if [ "$1" = thread ]; then arguments=(--gtest_filter='ThreadPool*:Block.SameSamples*'); fi
  "$BUILD_DIR/devel/lib/meshless_cutting/$target" "${arguments[@]}"
done
