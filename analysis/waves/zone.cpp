#include "waves/zone.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>

#include "base/error.hpp"

namespace eg {
namespace {

struct Zone {
  std::string_view lattice, path;
  std::vector<ZonePoint> points;
};

/// Names after Setyawan and Curtarolo (2010); hcp and hexagonal in the rectangular cell with rows along x.
const Zone& zone_of(std::string_view lattice, int dimension) {
  static const std::vector<Zone> zones{
      {"sc", "G X M G R", {{"G", {}}, {"X", {0, 0, .5}}, {"M", {0, .5, .5}}, {"R", {.5, .5, .5}}}},
      {"bcc", "G H N G P", {{"G", {}}, {"H", {0, 0, 1}}, {"N", {0, .5, .5}}, {"P", {.5, .5, .5}}}},
      {"fcc",
       "G X W L G K",
       {{"G", {}}, {"X", {0, 0, 1}}, {"W", {0, .5, 1}}, {"L", {.5, .5, .5}}, {"K", {0, .75, .75}}}},
      {"hcp",
       "G M K G A",
       {{"G", {}},
        {"M", {0, 1, 0}},
        {"K", {2. / 3, 0, 0}},
        {"A", {0, 0, .5}},
        {"L", {0, 1, .5}},
        {"H", {2. / 3, 0, .5}}}},
      {"square", "G X M G", {{"G", {}}, {"X", {.5, 0, 0}}, {"M", {.5, .5, 0}}}},
      {"hexagonal", "G M K G", {{"G", {}}, {"M", {0, 1, 0}}, {"K", {2. / 3, 0, 0}}}},
  };
  static const Zone plane{"", "X G Y", {{"G", {}}, {"X", {.5, 0, 0}}, {"Y", {0, .5, 0}}, {"M", {.5, .5, 0}}}};
  static const Zone space{
      "", "X G Y G Z", {{"G", {}}, {"X", {.5, 0, 0}}, {"Y", {0, .5, 0}}, {"Z", {0, 0, .5}}, {"R", {.5, .5, .5}}}};
  const auto found = std::ranges::find(zones, lattice, &Zone::lattice);
  return found != zones.end() ? *found : dimension == 2 ? plane : space;
}

ZonePoint parse_point(const std::string& word, const Zone& zone, int dimension) {
  const auto named = std::ranges::find(zone.points, word, &ZonePoint::name);
  if (named != zone.points.end()) return *named;
  std::istringstream in(word);
  ZonePoint point{word, {}};
  char comma = ',';
  bool good = true;
  for (int k = 0; k < dimension && good; ++k)
    good = (k == 0 || (in >> comma && comma == ',')) && (in >> point.reduced[k]);
  if (good && in.peek() == std::istringstream::traits_type::eof()) return point;
  std::string names;
  for (const auto& p : zone.points) names += (names.empty() ? "" : ", ") + p.name;
  throw InputError(fmt::format("--path: \"{}\" is no point of the Brillouin zone; take {} or {} numbers, e.g. {}", word,
                               names, dimension, dimension == 2 ? "0.25,0.5" : "0.5,0.5,0"));
}

}  // namespace

std::vector<ZonePoint> zone_points(std::string_view lattice, int dimension) {
  return zone_of(lattice, dimension).points;
}

std::string usual_path(std::string_view lattice, int dimension) {
  return std::string(zone_of(lattice, dimension).path);
}

std::vector<ZonePoint> parse_zone_path(const std::string& text, std::string_view lattice, int dimension) {
  const Zone& zone = zone_of(lattice, dimension);
  std::istringstream words(text);
  std::vector<ZonePoint> path;
  for (std::string word; words >> word;) {
    path.push_back(parse_point(word, zone, dimension));
    const auto n = path.size();
    if (n > 1 && norm(path[n - 1].reduced - path[n - 2].reduced) == 0)
      throw InputError(fmt::format("--path: {} follows itself; name different points", word));
  }
  if (path.size() < 2)
    throw InputError(fmt::format("--path: \"{}\" must name two points or more, e.g. \"{}\"", text, zone.path));
  return path;
}

Vec3 wave_vector(const Mat3& edges, const Vec3& reduced) {
  return transpose(inverse(edges)) * reduced * (2 * std::numbers::pi);
}

std::string shown_name(const std::string& name) { return name == "G" ? "Γ" : name; }

}  // namespace eg
