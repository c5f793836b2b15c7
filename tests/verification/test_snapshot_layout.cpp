// A snapshot read by its datasets alone, as docs/output.md tells other programs to: the stress comes out.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "dynamics/engine.hpp"
#include "io/hdf5_file.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "support/packings.hpp"

namespace eg {
namespace {

const char* text = R"(dimension = 3
seed = 3
material.soft = { density = 2650, friction = 0.3, normal_stiffness = 1e6, shear_stiffness = 7e5 }
contact.law = "linear"
specimen = { source = "cloud", count = 200, grading = { radius = 1e-3 }, solid_fraction = 0.5 }
boundary.type = "periodic"
)";

template <class T>
std::vector<T> all_of(const Hdf5Reader& file, const std::string& name) {
  Hdf5Shape shape;
  return file.read<T>(name, shape);
}

TEST(SnapshotLayout, StressFromTheDatasets) {
  const Scene scene = parse_scene(text);
  State state = make_state(scene, make_packing(scene));
  {
    Engine engine(scene, state);
    state.cell.rate(0, 0) = state.cell.rate(1, 1) = -30, state.cell.rate(2, 2) = -40, state.cell.rate(0, 1) = 20;
    for (int k = 0; k < 3000; ++k) engine.step(1e-6, TallyLevel::stress);
  }
  const auto path = std::filesystem::temp_directory_path() / ("eigengrain_layout_" + std::to_string(::getpid()));
  write_snapshot(path.string(), scene, state);
  const Hdf5Reader file(path.string());
  const auto x = all_of<double>(file, "grains/position"), r = all_of<double>(file, "grains/radius"),
             h = all_of<double>(file, "cell/matrix"), t = all_of<double>(file, "contacts/history"),
             virial = all_of<double>(file, "virial");
  const auto i = all_of<Index>(file, "contacts/i"), j = all_of<Index>(file, "contacts/j");
  const auto image = all_of<std::uint8_t>(file, "contacts/image");
  const std::size_t width = t.size() / i.size();
  std::array<double, 9> sum{};
  std::size_t touching = 0;
  for (std::size_t c = 0; c < i.size(); ++c) {
    const std::array<int, 3> step{image[c] % 3 - 1, image[c] / 3 % 3 - 1, image[c] / 9 - 1};
    if (i[c] == j[c] && image[c] == 13) continue;
    std::array<double, 3> l{};
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      l[k] = x[3 * j[c] + k] - x[3 * i[c] + k];
      for (std::size_t e = 0; e < 3; ++e) l[k] += h[3 * k + e] * step[e];
      square += l[k] * l[k];
    }
    const double length = std::sqrt(square), overlap = r[i[c]] + r[j[c]] - length;
    if (overlap <= 0) continue;
    ++touching;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t e = 0; e < 3; ++e) sum[3 * k + e] += (1e6 * overlap * l[k] / length - t[width * c + k]) * l[e];
  }
  EXPECT_GT(touching, 200u);
  EXPECT_LT(touching, i.size());  // near pairs are listed too
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(sum[k], virial[k], 1e-9 * std::abs(virial[0])) << k;
  EXPECT_GT(std::abs(virial[1]), 1e-3 * virial[0]);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace eg
