// The scenes of cases/: every one can be read, and its head says how to run it and what to expect.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/scene_file.hpp"

namespace eg {
namespace {

TEST(Cases, AreReadableAndSayHowToRunThem) {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(EIGENGRAIN_SOURCE_DIR "/cases")) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename());
    ++found;
    Scene scene;
    ASSERT_NO_THROW(scene = read_scene(entry.path().string()));
    const auto head = scene.text.substr(0, scene.text.find("\ntitle"));
    for (const char* word : {"run ", "source ", "expected "}) EXPECT_NE(head.find(word), std::string::npos) << word;
  }
  EXPECT_GE(found, 1);
}

}  // namespace
}  // namespace eg
