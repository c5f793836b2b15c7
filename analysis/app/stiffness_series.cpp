#include "app/stiffness_series.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assembly/linearise.hpp"
#include "base/error.hpp"
#include "io/hdf5_file.hpp"
#include "measure/homogenised.hpp"
#include "report/table.hpp"
#include "stiffness/backbone.hpp"
#include "stiffness/symmetry_fit.hpp"

namespace eg {
namespace {

StiffnessOfStage measured(const Scene& scene, const State& state, const StageSpec& stage, StiffnessSeries& series,
                          const RelaxationOptions& options) {
  const Homogenised h = homogenise(scene, state);
  StiffnessOfStage row{stage.name, h.mean_stress, h.void_ratio, h.coordination.mean};
  const Network network = backbone(linearise(scene, state)).network;
  if (network.springs.empty()) return row;
  const auto moduli = relax(network, periodic_strains(scene.dimension), h.volume, options);
  series.converged = series.converged && moduli.converged;
  const IsotropicFit fit = isotropic_fit({scene.dimension, moduli.total()});
  row.bulk = fit.bulk, row.shear = fit.shear;
  return row;
}

/// d ln(modulus)/d ln p between two rows; NaN where p did not change or either is not positive.
double exponent(double before, double after, double p_before, double p_after) {
  const double steps = std::log(p_after / p_before);
  return std::abs(steps) > 1e-3 ? std::log(after / before) / steps : NAN;
}

Table table_of(const StiffnessSeries& series) {
  const char* unit = series.dimension == 3 ? "Pa" : "N/m";
  Table t({{"stage"},
           {"mean_stress", "p", unit, 5},
           {"void_ratio", "e", "-", 4},
           {"coordination", "Z", "-", 4},
           {"bulk", "K", unit, 5},
           {"shear", "G", unit, 5},
           {"bulk_exponent", "d ln K/d ln p", "-", 4},
           {"shear_exponent", "d ln G/d ln p", "-", 4}});
  for (const auto& r : series.rows)
    t.add({r.stage, r.mean_stress, r.void_ratio, r.coordination, r.bulk, r.shear, r.bulk_exponent, r.shear_exponent});
  return t;
}

}  // namespace

StiffnessSeries stiffness_series(const std::string& name, const Scene& scene, State state,
                                 const RelaxationOptions& options) {
  if (scene.stages.empty())
    throw input_error(name, 0, "--stages", "asks for the moduli after every stage, and there is none",
                      "add [[stage]] to the scene, or leave it out");
  if (scene.boundary.kind != BoundarySpec::Kind::periodic)
    throw input_error(name, 0, "--stages", "follows the tensor of a periodic cell, and this packing has walls",
                      "leave it out");
  StiffnessSeries series{name, scene.title, scene.dimension, true, {}};
  run_quietly(scene, state, [&](const State& s, const StageSpec& stage) {
    StiffnessOfStage row = measured(scene, s, stage, series, options);
    if (!series.rows.empty()) {
      const auto& last = series.rows.back();
      row.bulk_exponent = exponent(last.bulk, row.bulk, last.mean_stress, row.mean_stress);
      row.shear_exponent = exponent(last.shear, row.shear, last.mean_stress, row.mean_stress);
    }
    series.rows.push_back(row);
  });
  if (series.rows.empty())
    throw input_error(name, 0, "--stages", "runs the stages of a scene, and those of this one are over",
                      "give the scene, or leave it out");
  return series;
}

std::string text_of(const StiffnessSeries& series) {
  return fmt::format("{}{}\n\nmoduli after every stage:\n{}{}", series.name,
                     series.title.empty() ? "" : ": " + series.title, table_of(series).text(),
                     series.converged ? "" : "NOT CONVERGED\n");
}

nlohmann::json json_of(const StiffnessSeries& series) {
  return {{"input", series.name},
          {"title", series.title},
          {"dimension", series.dimension},
          {"converged", series.converged},
          {"stages", table_of(series).json()}};
}

Figure figure_of(const StiffnessSeries& series) {
  const char* unit = series.dimension == 3 ? "Pa" : "N/m";
  Figure figure;
  figure.title = series.title.empty() ? series.name : series.title;
  figure.subtitle = "moduli at the end of every stage";
  figure.x = {.title = fmt::format("mean stress [{}]", unit), .logarithmic = true};
  figure.y = {.title = fmt::format("modulus [{}]", unit), .logarithmic = true};
  Series bulk{.label = "K", .points = true}, shear{.label = "G", .points = true}, hertz{.label = "slope 1/3"};
  for (const auto& r : series.rows) {
    if (!(r.mean_stress > 0 && r.shear > 0)) continue;
    bulk.x.push_back(r.mean_stress), bulk.y.push_back(r.bulk);
    shear.x.push_back(r.mean_stress), shear.y.push_back(r.shear);
  }
  for (const double p : shear.x) {  // through the last point: Hertz's law is where rough surfaces end
    hertz.x.push_back(p);
    hertz.y.push_back(shear.y.back() * std::cbrt(p / shear.x.back()));
  }
  figure.series = {bulk, shear, hertz};
  return figure;
}

void write_tables(const StiffnessSeries& series, const std::string& path) {
  Hdf5Writer file(path, path);
  const char* unit = series.dimension == 3 ? "Pa" : "N/m";
  const auto column = [&](const char* name, const char* of, double StiffnessOfStage::*member) {
    std::vector<double> values;
    for (const auto& r : series.rows) values.push_back(r.*member);
    file.write(name, of, {values.size()}, values);
  };
  column("mean_stress", unit, &StiffnessOfStage::mean_stress);
  column("void_ratio", "-", &StiffnessOfStage::void_ratio);
  column("coordination", "-", &StiffnessOfStage::coordination);
  column("bulk", unit, &StiffnessOfStage::bulk);
  column("shear", unit, &StiffnessOfStage::shear);
  column("bulk_exponent", "-", &StiffnessOfStage::bulk_exponent);
  column("shear_exponent", "-", &StiffnessOfStage::shear_exponent);
  file.close();
}

}  // namespace eg
