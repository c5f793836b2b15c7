// Any bytes as a scene: a scene that holds what it promises, or one line.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "io/scene_file.hpp"
#include "one_line.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  expect_result_or_one_line([&] {
    const auto scene = eg::parse_scene(text, "fuzz");
    const auto require = [](bool holds) {
      if (!holds) std::abort();
    };
    require(scene.text == text && (scene.dimension == 2 || scene.dimension == 3) && !scene.materials.empty());
    for (const auto& material : scene.materials) require(material.density > 0 && material.friction >= 0);
    for (const int cells : scene.specimen.cells) require(cells >= 1);
    for (const auto& wall : scene.boundary.walls) require(std::abs(norm(wall.normal) - 1) < 1e-12);
    require(scene.timestep.safety > 0 && scene.timestep.safety <= 1);
  });
  return 0;
}
