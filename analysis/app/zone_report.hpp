#pragma once
// Tables of void ratios in zones, as `eigengrain measure --zones` asks for them. Definitions: docs/measures.md.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measure/zone_grid.hpp"

namespace eg {

struct ZoneFlags {
  std::vector<std::string> zones;  ///< "radial:9", "height:5", "radial:4,sector:8,height:3", "x:4,z:0/0.01/0.03"
  std::string container;           ///< "cylinder:X,Y,R,BOTTOM,TOP", "box:X0,X1,Y0,Y1,Z0,Z1"; 2D without the heights
  std::string axis = "z";          ///< of cylinders
};

/// Adds --zones, --container and --zone-axis; `flags` must outlive the parsing.
void add_zone_options(CLI::App& command, ZoneFlags& flags);

struct ZoneReport {
  std::string zones;  ///< as asked for
  ZoneGrid grid;
  ZoneTable table;
};

/// One report an entry of flags.zones. Throws InputError, naming `input`, when a text makes no zones.
std::vector<ZoneReport> zone_reports(const State& state, const ZoneFlags& flags, const std::string& input);

std::string text_of(const ZoneReport& report, int dimension);
nlohmann::json json_of(const ZoneReport& report, int dimension);

}  // namespace eg
