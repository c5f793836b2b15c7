#include "app/since_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/number_words.hpp"
#include "base/error.hpp"
#include "io/snapshot.hpp"
#include "measure/gradient_fit.hpp"
#include "measure/shear_band.hpp"
#include "measure/volume.hpp"

namespace eg {
namespace {

using Rows = std::vector<Measured>;

constexpr double degree = std::numbers::pi / 180;

void add_vector(Rows& rows, const std::string& name, const std::string& unit, const Vec3& v, int dimension) {
  for (int k = 0; k < dimension; ++k) rows.push_back({fmt::format("{}_{}", name, "xyz"[k]), unit, v[k]});
}

void add_strain(Rows& rows, const Mat3& gradient, int dimension) {
  const SmallStrain strain = strain_of(gradient, dimension);
  Mat3 engineering = strain.tensor;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) engineering(k, l) *= k == l ? 1 : -2;  // positive where it is in the history
  add_tensor(rows, "strain", "-", engineering, dimension);
  rows.push_back({"volumetric_strain", "-", strain.volumetric});
  rows.push_back({"shear_strain", "-", strain.shear});
}

std::optional<Mat3> homogeneous(const Displacements& motion) {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < motion.size(); ++i) samples.push_back({motion.from[i], motion.displacement[i]});
  return fit_gradient(samples, motion.dimension);
}

Vec3 mean(const std::vector<Vec3>& all) {
  Vec3 sum;
  for (const auto& v : all) sum += (1 / static_cast<double>(all.size())) * v;
  return sum;
}

MeasureSection whole_section(const Since& s) {
  const int dimension = s.motion.dimension;
  double largest = 0;
  for (const auto& u : s.motion.displacement) largest = std::max(largest, norm(u));
  Rows rows{{"elapsed", "s", s.elapsed}, {"particles", "-", static_cast<std::int64_t>(s.motion.size())}};
  add_vector(rows, "displacement", "m", mean(s.motion.displacement), dimension);
  rows.push_back({"displacement_largest", "m", largest});
  if (const auto gradient = homogeneous(s.motion)) add_strain(rows, *gradient, dimension);
  rows.push_back({"strain_window", "m", s.window});
  return {"since", rows};
}

/// Mean local shear strain of the grains inside and outside the band.
std::array<double, 2> shear_in_and_out(const Since& s, const ShearBand& band) {
  std::array<double, 2> sum{}, count{};
  for (std::size_t i = 0; i < s.motion.size(); ++i) {
    const double shear = strain_of(s.gradients[i], s.motion.dimension).shear;
    if (!std::isfinite(shear)) continue;
    const std::size_t out = std::abs(dot(band.normal, s.motion.from[i]) - band.position) > band.thickness / 2;
    sum[out] += shear, ++count[out];
  }
  return {sum[0] / std::max(1.0, count[0]), sum[1] / std::max(1.0, count[1])};
}

MeasureSection band_section(const Since& s, const ShearBand& band, double d50) {
  const int dimension = s.motion.dimension;
  const auto [inside, outside] = shear_in_and_out(s, band);
  const double upright = std::min(1.0, std::abs(band.normal[dimension - 1]));
  Rows rows{{"explained", "-", band.explained},
            {"inclination", "deg", std::acos(upright) / degree},
            {"thickness", "m", band.thickness},
            {"thickness_over_d50", "-", band.thickness / d50}};
  add_vector(rows, "normal", "-", band.normal, dimension);
  rows.push_back({"position", "m", band.position});
  rows.push_back({"slip", "m", band.slip()});
  rows.push_back({"opening", "m", band.opening()});
  rows.push_back({"dilation_angle", "deg", std::atan2(band.opening(), band.slip()) / degree});
  rows.push_back({"shear_strain_inside", "-", inside});
  rows.push_back({"shear_strain_outside", "-", outside});
  return {"shear_band", rows};
}

MeasureSection gauge_section(const Since& s, const Vec3& place, std::size_t number, std::size_t grain, Index id) {
  Rows rows;
  const int dimension = s.motion.dimension;
  add_vector(rows, "place", "m", place, dimension);
  rows.push_back({"id", "-", static_cast<std::int64_t>(id)});
  add_vector(rows, "from", "m", s.motion.from[grain], dimension);
  add_vector(rows, "displacement", "m", s.motion.displacement[grain], dimension);
  rows.push_back({"displacement", "m", norm(s.motion.displacement[grain])});
  return {fmt::format("gauge_{}", number), rows};
}

void add_to_sphere(MeasureSection& section, const SphereDisplacement& moved, int dimension) {
  if (moved.grains == 0) return;
  add_vector(section.rows, "displacement", "m", moved.displacement, dimension);
  if (moved.gradient) add_strain(section.rows, *moved.gradient, dimension);
}

}  // namespace

void add_since_options(CLI::App& command, SinceFlags& flags) {
  command.add_option("--since", flags.snapshot, "displacements and strains since this earlier snapshot");
  command
      .add_option("--gauge", flags.gauges, "with --since: displacement of the grain nearest to X,Y,Z [m]; repeatable")
      ->delimiter(',')
      ->check(finite_option);
  command.add_option("--fields", flags.fields,
                     "with --since: displacement and strain of every grain for ParaView (.vtp)");
}

Since compare(const SinceFlags& flags, const State& now) {
  if (kind_of(flags.snapshot) != InputKind::snapshot)
    throw input_error(flags.snapshot, 0, "--since", "takes a snapshot (.h5)", "name an earlier one of the same run");
  const State before = read_snapshot(flags.snapshot).state;
  Since s;
  s.motion = displacements_between(before, now);
  s.elapsed = now.time - before.time;
  s.window = 2.5 * size_statistics(now).d50;
  s.gradients = local_gradients(s.motion, s.window);
  return s;
}

void add_since(MeasureReport& report, const Since& s, const SinceFlags& flags, const State& now,
               std::span<const MeasureSphere> spheres) {
  const int dimension = s.motion.dimension;
  for (std::size_t k = 0; k < spheres.size(); ++k)
    for (auto& section : report.sections)
      if (section.key == fmt::format("sphere_{}", k + 1))
        add_to_sphere(section, displacement_inside(s.motion, spheres[k]), dimension);
  report.sections.push_back(whole_section(s));
  if (const auto band = find_shear_band(s.motion.from, s.motion.displacement, dimension))
    report.sections.push_back(band_section(s, *band, size_statistics(now).d50));
  for (std::size_t k = 0; k < flags.gauges.size(); ++k) {
    const auto& g = flags.gauges[k];
    if (g.size() != static_cast<std::size_t>(dimension))
      throw input_error(report.name, 0, "--gauge", fmt::format("takes {} numbers in {}D", dimension, dimension),
                        dimension == 3 ? "give X,Y,Z in m" : "give X,Y in m");
    const Vec3 place{g[0], g[1], dimension == 3 ? g[2] : 0};
    const std::size_t grain = nearest_grain(s.motion, place);
    report.sections.push_back(gauge_section(s, place, k + 1, grain, now.grains.id[s.motion.now[grain]]));
  }
}

std::vector<GrainField> since_fields(const Since& s, std::size_t grains) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<GrainField> fields;
  for (const auto& [name, components] : {std::pair{"displacement", 3},
                                         {"fluctuation", 3},
                                         {"strain", 6},
                                         {"volumetric_strain", 1},
                                         {"shear_strain", 1},
                                         {"rotation", 3}})
    fields.push_back({name, components, std::vector<double>(grains * static_cast<std::size_t>(components), none)});
  const Mat3 whole = homogeneous(s.motion).value_or(Mat3{});
  const Vec3 from = mean(s.motion.from), by = mean(s.motion.displacement);
  const auto set = [&](std::size_t field, std::size_t grain, std::initializer_list<double> values) {
    std::ranges::copy(values, fields[field].data.begin() + static_cast<std::ptrdiff_t>(grain * values.size()));
  };
  for (std::size_t i = 0; i < s.motion.size(); ++i) {
    const std::size_t place = s.motion.now[i];
    const Vec3 u = s.motion.displacement[i], own = u - by - whole * (s.motion.from[i] - from);
    const SmallStrain strain = strain_of(s.gradients[i], s.motion.dimension);
    const Mat3& e = strain.tensor;
    set(0, place, {u.x, u.y, u.z});
    set(1, place, {own.x, own.y, own.z});
    set(2, place, {e(0, 0), e(1, 1), e(2, 2), e(0, 1), e(1, 2), e(0, 2)});  // the order of ParaView
    set(3, place, {strain.volumetric});
    set(4, place, {strain.shear});
    set(5, place, {strain.rotation.x, strain.rotation.y, strain.rotation.z});
  }
  return fields;
}

}  // namespace eg
