// The neighbour search against all pairs in all images.
#include <gtest/gtest.h>

#include <set>

#include "base/random.hpp"
#include "search/grid.hpp"

namespace eg {
namespace {

using PairSet = std::multiset<std::tuple<Index, Index, int>>;

PairSet by_force(const Grains& grains, const Cell& cell, double skin) {
  PairSet pairs;
  for (Index i = 0; i < grains.size(); ++i)
    for (Index j = i; j < grains.size(); ++j)
      for (std::uint8_t image = 0; image < Cell::images; ++image) {
        const auto step = Cell::steps(image);
        bool allowed = true;
        for (std::size_t k = 0; k < 3; ++k) allowed = allowed && (step[k] == 0 || cell.periodic[k]);
        if (!allowed || (i == j && image <= Cell::home)) continue;
        const Vec3 branch = grains.position[j].vec() + cell.shift(image) - grains.position[i].vec();
        const double reach = grains.radius(i) + grains.radius(j) + skin;
        if (dot(branch, branch) < reach * reach) pairs.insert({i, j, image});
      }
  return pairs;
}

struct Arrangement {
  const char* name;
  std::size_t count;
  double edge, tilt, largest;  // cell, its xy tilt, largest radius; the smallest is 1
  std::array<bool, 3> periodic;
};

class Pairs : public testing::TestWithParam<Arrangement> {};

TEST_P(Pairs, AreThoseOfAllImages) {
  const Arrangement& p = GetParam();
  Random random(7);
  for (int trial = 0; trial < 5; ++trial) {
    Cell cell;
    cell.h = Mat3{};
    for (int k = 0; k < 3; ++k) cell.h(k, k) = p.edge;
    cell.h(0, 1) = p.tilt * p.edge;
    cell.periodic = p.periodic;
    Grains grains;
    for (std::size_t i = 0; i < p.count; ++i) {
      const Vec3 x = cell.h * Vec3{random.uniform(), random.uniform(), random.uniform()};
      grains.position.push_back({x.x, x.y, x.z, random.uniform(1, p.largest)});
    }
    PairSet found;
    for (const auto& pair : find_pairs(grains, cell, 0.1)) found.insert({pair.i, pair.j, pair.image});
    EXPECT_EQ(found, by_force(grains, cell, 0.1));
    EXPECT_FALSE(found.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Pairs,
                         testing::Values(Arrangement{"periodic", 300, 20, 0, 1.5, {true, true, true}},
                                         Arrangement{"tilted", 300, 20, 0.4, 1.5, {true, true, true}},
                                         Arrangement{"narrow", 20, 3.5, 0, 1.5, {true, true, true}},
                                         Arrangement{"two_cells", 60, 6.8, 0, 1.5, {true, true, true}},
                                         Arrangement{"ratio", 200, 24, 0, 8, {true, true, true}},
                                         Arrangement{"slope", 300, 20, 0, 1.5, {true, true, false}},
                                         Arrangement{"free", 300, 20, 0, 3, {false, false, false}}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace eg
