// What a run leaves in its folder, by the command line.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/case_run.hpp"
#include "support/scene_text.hpp"

namespace {

namespace fs = std::filesystem;
using namespace eg::test;

/// A folder of its own that holds a scene of a few steps.
class RunFolder : public testing::Test {
 protected:
  RunFolder() : folder_(fs::temp_directory_path() / ("eigengrain_folder_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "scene.toml") << "dimension = 3\n" + quartz + R"([contact]
law = "hertz-mindlin"
[specimen]
source = "cloud"
count = 100
grading = { radius = 1e-4 }
[boundary]
type = "periodic"
[[stage]]
name = "press"
strain_rate = { x = 10, y = 10, z = 10 }
until = { steps = 40 }
record = { every_steps = 10, snapshot_every_steps = 20, snapshot_at_end = true }
)";
  }
  ~RunFolder() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void run(const std::string& input, const std::string& out, const std::string& flags = "") const {
    output("run " + at(input) + " --json --out " + at(out) + " " + flags);
  }

 private:
  fs::path folder_;
};

TEST_F(RunFolder, NothingOfAnEarlierRunStaysBesideTheNewOne) {
  run("scene.toml", "a");
  ASSERT_TRUE(fs::exists(at("a/step_000000020.h5")) && fs::exists(at("a/stage_press.h5")));
  std::ofstream(at("a/mine.txt")) << "notes";
  run("scene.toml", "a", "--overwrite --set stage[1].record='{ every_steps = 10 }'");
  EXPECT_TRUE(fs::exists(at("a/final.h5")));
  EXPECT_FALSE(fs::exists(at("a/step_000000020.h5")));
  EXPECT_FALSE(fs::exists(at("a/stage_press.h5")));
  EXPECT_EQ(text("a/mine.txt"), "notes");
}

TEST_F(RunFolder, ARunThatGoesOnElsewhereTakesItsHistoryAlong) {
  run("scene.toml", "a");
  run("a/step_000000020.h5", "b");
  ASSERT_FALSE(text("a/history.csv").empty());
  EXPECT_EQ(text("a/history.csv"), text("b/history.csv"));
  EXPECT_EQ(text("a/final.vtp"), text("b/final.vtp"));
}

TEST_F(RunFolder, ARunThatGoesOnDoesNotBuryAnother) {
  run("scene.toml", "a");
  run("scene.toml", "b");
  const std::string before = text("b/history.csv");
  const std::string again = " run " + at("a/step_000000020.h5") + " --out " + at("b") + " 2>/dev/null";
  EXPECT_NE(std::system((EIGENGRAIN_PROGRAM + again).c_str()), 0);
  EXPECT_EQ(text("b/history.csv"), before);
  EXPECT_TRUE(fs::exists(at("b/final.h5")));
}

}  // namespace
