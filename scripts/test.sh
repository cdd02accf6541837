#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, runs all tests. Further arguments go to ctest.
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install_build_dependencies
install "${SCREENSHOT_PACKAGES[@]}"
build -DMESHLESS_CUTTING_WERROR=ON
say "Testing"
cd "$BUILD_DIR"
exec ctest --output-on-failure -j"$(nproc)" "$@"
