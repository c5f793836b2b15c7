// The documentation names what the program prints: every column of the history, every rule of thumb, every scene key.
#include <gtest/gtest.h>

#include "app/record.hpp"
#include "assembly/linearise.hpp"
#include "contact/laws.hpp"
#include "dynamics/engine.hpp"
#include "io/text_file.hpp"
#include "support/scenes.hpp"
#include "timestep/estimates.hpp"

namespace eg {
namespace {

std::string page(const std::string& name) { return read_file(EIGENGRAIN_SOURCE_DIR "/docs/" + name); }

void expect_named(const std::string& text, const std::string& name) {
  EXPECT_NE(text.find("`" + name + "`"), std::string::npos) << name << " is not documented";
}

TEST(Docs, EveryColumnOfTheHistory) {
  const std::string text = page("output.md");
  Scene scene;
  scene.energy = true;
  for (const auto& column : history_columns(scene))
    if (!column.name.starts_with("strain_") && !column.name.starts_with("stress_")) expect_named(text, column.name);
}

TEST(Docs, EveryRuleOfThumb) {
  const std::string text = page("timestep.md");
  const Scene scene = test::lattice_scene("hertz-mindlin", "fcc", {2, 2, 2}, 1e-4);
  State state = test::state_of(scene);
  const Engine lists(scene, state);
  const auto rows = time_step_estimates(linearise(scene, state), {29e9, 0.12, 2650, 1});
  EXPECT_GE(rows.size(), 15u);
  for (const auto& row : rows) expect_named(text, row.name);
}

TEST(Docs, EveryConstantOfEveryLaw) {
  const std::string text = page("scene.md");
  for (const auto& name : law_names()) {
    EXPECT_NE(text.find("`\"" + name + "\"`"), std::string::npos) << name;
    with_law(name, [&](auto law) {
      for (const auto& set : law.constant_sets())
        for (const auto& constant : set) expect_named(text, std::string(constant.key));
      for (const auto& constant : further_constants<decltype(law)>()) expect_named(text, std::string(constant.key));
    });
  }
}

}  // namespace
}  // namespace eg
