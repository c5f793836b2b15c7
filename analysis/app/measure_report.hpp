#pragma once
// What `eigengrain measure` has to say of a packing, as text and JSON. Definitions: docs/measures.md.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/prepare.hpp"
#include "measure/distribution.hpp"
#include "measure/force_chains.hpp"
#include "measure/grain_stress.hpp"
#include "measure/homogenised.hpp"
#include "measure/measure_sphere.hpp"
#include "measure/rose.hpp"
#include "report/table.hpp"

namespace eg {

/// A number, or a few that belong together, with the name it has in JSON.
struct Measured {
  std::string key, unit;
  Value value;
};

struct MeasureSection {
  std::string key;  ///< "stress", "fabric" …
  std::vector<Measured> rows;
};

/// Rows of the components of the symmetric part: name_x … name_xy.
void add_tensor(std::vector<Measured>& rows, const std::string& name, const std::string& unit, const Mat3&,
                int dimension);

struct MeasureReport {
  std::string name, title;
  int dimension = 3;
  std::vector<MeasureSection> sections;
  std::vector<SizeFraction> fractions;
  std::vector<std::vector<double>> pair_shares;  ///< stress_by_pair()
  std::vector<std::size_t> connectivity;
  Histogram forces;
  Spins spins;
  std::vector<Petal> rose;
  std::vector<std::string> warnings;
};

/// All measures of a packing with up-to-date lists. `splits`: diameters [m] between size fractions, empty for
/// natural_splits(); `spheres`: a section each.
MeasureReport measure_report(const Snapshot& packing, const std::string& name, std::span<const ContactPoint> contacts,
                             std::vector<double> splits, std::span<const MeasureSphere> spheres);

std::string text_of(const MeasureReport& report);
nlohmann::json json_of(const MeasureReport& report);

}  // namespace eg
