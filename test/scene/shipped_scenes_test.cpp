// Every scene file that the package ships can be read.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scene/scene_reader.h"

namespace meshless_cutting {
namespace {

TEST(ShippedScenesTest, EveryOneReads) {
  const std::filesystem::path source = MESHLESS_CUTTING_SOURCE_DIR;
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source / "launch")) {
    if (entry.path().extension() != ".yaml") continue;
    std::ifstream stream(entry.path());
    const std::string text((std::istreambuf_iterator<char>(stream)), {});
    if (text.find("scene_version") == std::string::npos) continue;  // way-points
    ++scenes;
    try {
      const Scene scene = ReadScene(entry.path());
      EXPECT_FALSE(scene.object.name.empty()) << entry.path();
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GE(scenes, 4);
}

}  // namespace
}  // namespace meshless_cutting
