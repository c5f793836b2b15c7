// Volumes common to grains and zones: closed forms, limits, and zones that share out space.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "measure/volume.hpp"
#include "measure/zone.hpp"

namespace eg {
namespace {

constexpr double pi = std::numbers::pi, everywhere = INFINITY;

double in_cylinder(double cylinder, double offset, double radius) {
  CylinderZone zone;
  zone.radius.high = cylinder;
  return volume_inside(zone, 3, {offset, 0, 0}, radius);
}

TEST(Zone, CylinderOnTheAxisHasItsClosedForm) {
  for (const double r : {0.3, 1.0, 2.7})
    for (const double share : {1e-3, 0.1, 0.5, 0.9, 0.999, 1.0}) {
      const double exact = grain_volume(3, r) * -std::expm1(1.5 * std::log1p(-share * share));
      EXPECT_NEAR(in_cylinder(share * r, 0, r) / exact, 1, 1e-13) << r << " " << share;
    }
}

TEST(Zone, CylinderThroughTheCentreIsVivianis) {
  // a cylinder of half the radius, half the radius off: (2/3)(π − 4/3) r³ (Viviani 1692)
  EXPECT_NEAR(in_cylinder(0.5, 0.5, 1), 2. / 3 * (pi - 4. / 3), 1e-15);
  EXPECT_NEAR(in_cylinder(1.5, 1.5, 3), 18 * (pi - 4. / 3), 1e-13);
}

TEST(Zone, KnownValuesOfTheReference) {
  EXPECT_NEAR(in_cylinder(0.5, 0, 1), 1.4680911584, 5e-11);
  EXPECT_NEAR(in_cylinder(0.5, 0.5, 1), 1.2055062135, 5e-11);
  const BoxZone cap{{}, {}, {0.7, everywhere}}, slab{{}, {}, {-0.2, 0.5}};
  EXPECT_NEAR(volume_inside(cap, 3, {}, 1), 0.2544690049, 5e-11);
  EXPECT_NEAR(volume_inside(slab, 3, {}, 1), 2.0598375832, 5e-11);
}

TEST(Zone, CylinderAgreesWithIntegralsOfThirtyDigits) {
  struct Known {
    double r, cylinder, offset, inside, outside;
  };
  for (const auto& k : {Known{1, 1.5, 0.51, 4.1882523338239492, 0.00053787096244176366},
                        Known{1, 0.5, 1.49, 0.00018087578636298088, 4.188609329000028},
                        Known{0.3, 10, 9.9, 0.083522571612505955, 0.029574763916726602},
                        Known{2, 0.7, 1.1, 4.845857894934432, 28.664463743356696},
                        Known{2.38, 50.8, 49.3, 51.301504845171843, 5.1687152564891961}}) {
    CylinderZone beyond;
    beyond.radius.low = k.cylinder;
    EXPECT_NEAR(in_cylinder(k.cylinder, k.offset, k.r) / k.inside, 1, 1e-12) << k.cylinder << " " << k.offset;
    EXPECT_NEAR(volume_inside(beyond, 3, {0, k.offset, 0}, k.r) / k.outside, 1, 1e-12) << k.cylinder;
  }
}

TEST(Zone, HalvesQuartersAndEighths) {
  const double whole = grain_volume(3, 2);
  for (const double angle : {0.0, 0.3, 2.0, 6.0}) {
    CylinderZone half;
    half.angle = {angle, angle + pi};
    EXPECT_NEAR(volume_inside(half, 3, {}, 2), whole / 2, 1e-13);
    half.angle.high = angle + pi / 3;
    EXPECT_NEAR(volume_inside(half, 3, {}, 2), whole / 6, 1e-13);
    half.height.low = 0;
    EXPECT_NEAR(volume_inside(half, 3, {}, 2), whole / 12, 1e-13);
  }
  const BoxZone corner{{0, everywhere}, {0, everywhere}, {0, everywhere}}, edge{{0, 9}, {0, 9}, {}};
  EXPECT_NEAR(volume_inside(corner, 3, {}, 2), whole / 8, 1e-13);
  EXPECT_NEAR(volume_inside(edge, 3, {}, 2), whole / 4, 1e-13);
}

TEST(Zone, AWedgeIsCutByItsPlanesOnly) {
  // far from the axis a sector is the space between two planes, here one through the sphere
  for (const double height : {-0.9, -0.3, 0.0, 0.5, 0.99}) {
    CylinderZone wedge;
    wedge.angle = {0, pi};
    EXPECT_NEAR(volume_inside(wedge, 3, {50, height, 0}, 1), cap_volume(3, 1, -height), 1e-12) << height;
  }
}

TEST(Zone, ABoxTwiceCutAgreesWithTheWedge) {
  // two planes at right angles, seen as a box and as a quarter of a cylinder
  Random random(3);
  for (int k = 0; k < 50; ++k) {
    const Vec3 x{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    CylinderZone wedge{.height = {0, 0.4}};
    wedge.angle = {0, pi / 2};
    const BoxZone box{{0, everywhere}, {0, everywhere}, {0, 0.4}};
    EXPECT_NEAR(volume_inside(wedge, 3, x, 0.8), volume_inside(box, 3, x, 0.8), 1e-13);
  }
}

/// Zones that share out all space, their edges at `edge` and infinity.
std::vector<CylinderZone> cylinder_zones(const std::vector<double>& radii, const std::vector<double>& heights,
                                         const std::vector<double>& angles) {
  std::vector<CylinderZone> zones;
  for (std::size_t a = 0; a + 1 < radii.size(); ++a)
    for (std::size_t b = 0; b + 1 < heights.size(); ++b)
      for (std::size_t c = 0; c + 1 < angles.size(); ++c)
        zones.push_back({{heights[b], heights[b + 1]}, {radii[a], radii[a + 1]}, {angles[c], angles[c + 1]}});
  return zones;
}

template <class Zone>
double shared_out(const std::vector<Zone>& zones, int dimension, const Vec3& x, double r) {
  double sum = 0;
  for (const auto& zone : zones) sum += volume_inside(zone, dimension, x, r);
  return sum / grain_volume(dimension, r);
}

TEST(Zone, ZonesShareOutEveryGrainToRoundOff) {
  Random random(7);
  const std::vector<double> radii{0, 0.7, 1.5, everywhere}, heights{-everywhere, -0.5, 0.4, everywhere};
  const auto rings = cylinder_zones(radii, heights, {0, 2 * pi});
  const auto wedges = cylinder_zones(radii, heights, {-1, 0.2, 1.5, 3, 2 * pi - 1});
  std::vector<BoxZone> boxes;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t c = 0; c < 3; ++c)
        boxes.push_back({{heights[a], heights[a + 1]}, {heights[b], heights[b + 1]}, {heights[c], heights[c + 1]}});
  for (int k = 0; k < 300; ++k) {
    const Vec3 x{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    const double r = std::pow(10, random.uniform(-4, 0.3));
    EXPECT_NEAR(shared_out(rings, 3, x, r), 1, 1e-13) << x.x << " " << x.y << " " << x.z << " " << r;
    EXPECT_NEAR(shared_out(wedges, 3, x, r), 1, 1e-11) << x.x << " " << x.y << " " << x.z << " " << r;
    EXPECT_NEAR(shared_out(boxes, 3, x, r), 1, 1e-13) << x.x << " " << x.y << " " << x.z << " " << r;
    const auto flat = cylinder_zones(radii, {-everywhere, everywhere}, {0.5, 3, 0.5 + 2 * pi});
    EXPECT_NEAR(shared_out(flat, 2, x, r), 1, 1e-11);
  }
}

TEST(Zone, EdgesThroughCentresAndTangentGrainsAreNothingSpecial) {
  const std::vector<double> angles{0, pi / 2, pi, 3 * pi / 2, 2 * pi};
  for (const double step : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8, 1e-4})
    for (const auto& x :
         {Vec3{1, 0, 0}, Vec3{0, 2, 1}, Vec3{1.5, 0, 0.5}, Vec3{-1.5, 0, 0}, Vec3{0, 0, 0}, Vec3{0.5, 0.5, 0}})
      for (const double r : {0.5, 1.0, 1.5}) {
        const auto zones = cylinder_zones({0, 1, 2, everywhere}, {-everywhere, 0, 1, everywhere}, angles);
        EXPECT_NEAR(shared_out(zones, 3, x + Vec3{step, -step, step}, r), 1, 1e-13) << step << " " << x.x << " " << r;
        const auto rings = cylinder_zones({0, 1, 2, everywhere}, {-everywhere, everywhere}, {0, 2 * pi});
        EXPECT_NEAR(shared_out(rings, 3, x + Vec3{step, -step, step}, r), 1, 1e-13) << step << " " << x.x << " " << r;
      }
}

TEST(Zone, VolumesTurnWithTheirZones) {
  Random random(11);
  for (int k = 0; k < 40; ++k) {
    const double turn = random.uniform(0, 10), c = std::cos(turn), s = std::sin(turn), lift = random.uniform(-2, 2);
    const Vec3 x{random.uniform(-2, 2), random.uniform(-2, 2), 0.1};
    CylinderZone zone{{-0.2, 0.6}, {0.5, 1.4}, {0.3, 2.1}}, turned = zone;
    turned.height = {zone.height.low + lift, zone.height.high + lift};
    turned.angle = {zone.angle.low + turn, zone.angle.high + turn};
    const Vec3 moved{c * x.x - s * x.y, s * x.x + c * x.y, x.z + lift};
    EXPECT_NEAR(volume_inside(turned, 3, moved, 0.8), volume_inside(zone, 3, x, 0.8), 1e-13);
  }
}

TEST(Zone, CountsAgreeWithVolumes) {
  // points thrown into the sphere fall into the zone as often as its share says
  Random random(5);
  const CylinderZone zone{{-0.3, 0.5}, {0.6, 1.3}, {-0.4, 0.7}};
  const BoxZone box{{0.3, 1.4}, {-0.6, 0.1}, {-0.2, 0.3}};
  const Vec3 centre{0.9, -0.1, 0.05};
  constexpr int throws = 400000;
  double in_zone = 0, in_box = 0, in_sphere = 0;
  for (int k = 0; k < throws; ++k) {
    const Vec3 p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (norm(p) > 1) continue;
    ++in_sphere;
    in_zone += holds(zone, 3, centre + p), in_box += holds(box, 3, centre + p);
  }
  EXPECT_NEAR(in_zone / in_sphere, volume_inside(zone, 3, centre, 1) / grain_volume(3, 1), 3e-3);
  EXPECT_NEAR(in_box / in_sphere, volume_inside(box, 3, centre, 1) / grain_volume(3, 1), 3e-3);
}

TEST(Zone, DisksHaveAreas) {
  const CylinderZone ring{{}, {0.5, 1}, {0, 2 * pi}};
  EXPECT_NEAR(volume_inside(ring, 2, {}, 2), pi * 0.75, 1e-14);
  EXPECT_NEAR(volume_inside(ring, 2, {0.8, 0, 77}, 0.3), lens_volume(2, 0.3, 1, 0.8), 1e-15);
  const BoxZone box{{0, 5}, {0.5, 5}, {}};
  EXPECT_NEAR(volume_inside(box, 2, {}, 1), 0.5 * cap_volume(2, 1, 0.5), 1e-15);
  EXPECT_NEAR(volume_inside(BoxZone{{-0.1, 0.1}, {-0.2, 0.2}, {}}, 2, {}, 1), 0.08, 1e-15);
}

TEST(Zone, WholeGrainsAndNone) {
  const CylinderZone zone{{0, 4}, {1, 3}, {0, 1}};
  const Vec3 in{2 * std::cos(0.5), 2 * std::sin(0.5), 2};
  EXPECT_EQ(volume_inside(zone, 3, in, 0.3), grain_volume(3, 0.3));
  EXPECT_EQ(volume_inside(zone, 3, -in, 0.3), 0);
  EXPECT_EQ(volume_inside(zone, 3, in + Vec3{0, 0, 9}, 0.3), 0);
  EXPECT_NEAR(volume_of(zone, 3), 16, 1e-14);
  EXPECT_NEAR(volume_of(zone, 2), 4, 1e-14);
}

}  // namespace
}  // namespace eg
