// Parts of a snapshot: together they are the whole, each with what it needs to be linearised.
#include <gtest/gtest.h>

#include <algorithm>

#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"
#include "dynamics/engine.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot_part.hpp"
#include "scratch.hpp"
#include "support/scene_text.hpp"
#include "support/scenes.hpp"

namespace eg {
namespace {

const std::string text = "title = \"parts\"\ndimension = 3\n" + test::quartz + R"([contact]
law = "hertz-mindlin"
[specimen]
source = "lattice"
lattice = "fcc"
radius = 1e-3
cells = [7, 7, 6]
overlap = 0.01
radius_scatter = 0.002
[boundary]
type = "periodic"
)";

TEST(SnapshotPart, PartsAddUpToTheWhole) {
  const Scene scene = parse_scene(text, "parts.toml");
  State state = test::state_of(scene);
  { Engine lists(scene, state); }
  const Scratch folder;
  const std::string path = folder / "parts.h5";
  write_snapshot(path, scene, state);
  const Network whole = linearise(scene, state);
  const Eigen::SparseMatrix<double> expected = stiffness_matrix(whole);  // 1,176 grains: two chunks of contacts
  for (const std::size_t parts : {1u, 2u, 3u, 7u}) {
    Eigen::SparseMatrix<double> sum(expected.rows(), expected.cols());
    std::size_t own = 0;
    for (std::size_t k = 0; k < parts; ++k) {
      const SnapshotPart part = read_snapshot_part(path, k, parts);
      EXPECT_EQ(part.grains, whole.size());
      own += part.own;
      Network net = linearise(part.scene, part.state);
      for (std::size_t g = 0; g < net.size(); ++g) {
        EXPECT_EQ(net.radius[g], whole.radius[part.number[g]]);
        EXPECT_EQ(net.inverse_mass[g], whole.inverse_mass[part.number[g]]);
      }
      for (Spring& s : net.springs) s.i = part.number[s.i], s.j = s.j == no_index ? s.j : part.number[s.j];
      Network placed = whole;
      placed.springs = net.springs;
      sum += stiffness_matrix(placed);
    }
    EXPECT_EQ(own, whole.size());
    EXPECT_LT((sum - expected).norm(), 1e-13 * expected.norm()) << parts;
  }
}

}  // namespace
}  // namespace eg
