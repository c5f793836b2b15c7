#pragma once
// What `eigengrain stiffness` has to say, as text, JSON, HDF5 tables and figure.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "measure/homogenised.hpp"
#include "measure/tensor.hpp"
#include "report/plot.hpp"
#include "stiffness/effective_medium.hpp"
#include "stiffness/probe.hpp"
#include "stiffness/relaxation.hpp"
#include "stiffness/symmetry_fit.hpp"

namespace eg {

struct DirectionRow {
  Vec3 direction;  ///< unit
  double young = 0, poisson = 0;
  WaveSpeeds waves;
};

struct EffectiveRow {
  std::string name, source;
  BulkShear moduli;
};

/// Extremes over all directions.
struct SpeedRange {
  double lowest = 0, mean = 0, highest = 0;  ///< [m/s]
};

struct StiffnessReport {
  std::string name, title;
  int dimension = 3;
  bool rotation = true, periodic = true;
  std::size_t particles = 0, rattlers = 0, contacts = 0;
  double volume = 0;   ///< of the cell, or between the walls [m³] (2D: m²)
  double density = 0;  ///< of the packing, voids included [kg/m³]
  Homogenised state;
  std::vector<std::string> loads;  ///< rows of the moduli
  RelaxedModuli moduli;
  std::optional<ProbedModuli> probed;
  double elapsed = 0;  ///< of the solution [s]

  // Periodic packings only:
  ElasticTensor tensor;
  Eigen::VectorXd eigenmoduli;
  IsotropicFit isotropic, affine;
  std::optional<TransverseFit> transverse;  ///< 3D
  Principal principal;                      ///< of the dilatational tensor C_ijkk [Pa]
  Principal fabric;                         ///< of Φ
  double fabric_angle = NAN;                ///< between their first axes [deg]; NaN where one has none
  std::vector<DirectionRow> directions, sphere;
  std::vector<SpeedRange> ranges;  ///< of P, S1, S2 over the sphere
  std::vector<EffectiveRow> effective;
};

/// Everything that follows from report.moduli of a periodic packing. `material`: of the grains, for the theories that
/// need G and ν (not NaN only if the law is of Hertz's kind).
void complete(StiffnessReport& report, const Network& network, const std::vector<Vec3>& directions,
              const Material& material);

std::string text_of(const StiffnessReport& report);
nlohmann::json json_of(const StiffnessReport& report);
/// Speeds of P and S waves from axis to axis; periodic packings only.
Figure figure_of(const StiffnessReport& report);
/// Throws RunError when the file cannot be written.
void write_tables(const StiffnessReport& report, const std::string& path);

}  // namespace eg
