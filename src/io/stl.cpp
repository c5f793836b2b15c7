#include "io/stl.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

#include "base/error.hpp"
#include "io/text_file.hpp"

namespace eg {

namespace {

using Facets = std::vector<std::array<Vec3, 3>>;

InputError damaged(const std::string& path, std::string_view fault) {
  return input_error(path, 0, "is no STL file:", fault, "export the mesh again, as binary or ASCII STL");
}

/// 80 bytes of text, the number of facets, and 50 bytes each: normal, three corners, two bytes more (3D Systems 1988).
Facets read_binary(const std::string& bytes, std::uint32_t count) {
  Facets facets(count);
  for (std::size_t f = 0; f < count; ++f) {
    std::array<float, 12> x{};
    std::memcpy(x.data(), bytes.data() + 84 + 50 * f, sizeof x);
    for (std::size_t k = 0; k < 3; ++k) facets[f][k] = {x[3 * k + 3], x[3 * k + 4], x[3 * k + 5]};
  }
  return facets;
}

Facets read_ascii(const std::string& bytes, const std::string& path) {
  std::istringstream in(bytes);
  Facets facets;
  std::string word;
  std::size_t corners = 0;
  while (in >> word) {
    if (word != "vertex") continue;
    Vec3 x;
    if (!(in >> x.x >> x.y >> x.z)) throw damaged(path, fmt::format("corner {} holds no three numbers", corners + 1));
    if (corners % 3 == 0) facets.emplace_back();
    facets.back()[corners++ % 3] = x;
  }
  if (corners % 3 != 0) throw damaged(path, "its last facet is cut short");
  return facets;
}

Facets read_facets(const std::string& path) {
  static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
  const std::string bytes = read_file(path);
  std::uint32_t count = 0;
  if (bytes.size() >= 84) std::memcpy(&count, bytes.data() + 80, sizeof count);
  if (bytes.size() >= 84 && bytes.size() == 84 + 50 * static_cast<std::size_t>(count)) return read_binary(bytes, count);
  if (!bytes.starts_with("solid")) throw damaged(path, "it is neither ASCII nor of the length its facets need");
  return read_ascii(bytes, path);
}

double size_of(const Facets& facets) {
  Vec3 low = facets[0][0], high = low;
  for (const auto& f : facets)
    for (const Vec3& x : f)
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
  return norm(high - low);
}

using Corner = std::array<std::int64_t, 3>;

/// Corners that coincide take the place of the first; their numbers go to `corner`.
std::vector<std::array<std::size_t, 3>> join_corners(Facets& facets, double tolerance) {
  std::map<Corner, std::pair<std::size_t, Vec3>> seen;
  std::vector<std::array<std::size_t, 3>> numbers(facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3& x = facets[f][k];
      const auto cell = [&](double v) { return static_cast<std::int64_t>(std::llround(v / tolerance)); };
      const Corner home{cell(x.x), cell(x.y), cell(x.z)};
      auto found = seen.end();
      for (int n = 0; n < 27 && found == seen.end(); ++n)
        found = seen.find({home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1});
      if (found == seen.end()) found = seen.emplace(home, std::pair(seen.size(), x)).first;
      numbers[f][k] = found->second.first, x = found->second.second;
    }
  return numbers;
}

void check_surface(const MeshSpec& mesh, const std::vector<std::array<std::size_t, 3>>& corner,
                   const std::string& path) {
  std::map<std::array<std::size_t, 2>, std::vector<std::pair<std::size_t, bool>>> edges;
  for (std::size_t f = 0; f < corner.size(); ++f) {
    const auto& x = mesh.facets[f];
    if (!(norm(cross(x[1] - x[0], x[2] - x[0])) > 0) || corner[f][0] == corner[f][1] || corner[f][1] == corner[f][2] ||
        corner[f][2] == corner[f][0])
      throw input_error(path, 0, fmt::format("facet {}", f + 1), "has no area", "repair the mesh");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = corner[f][k], b = corner[f][(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back({f, a < b});
    }
  }
  for (const auto& [ends, sharers] : edges) {
    const auto facet = fmt::format("facet {}", sharers[0].first + 1);
    if (sharers.size() > 2)
      throw input_error(path, 0, facet, fmt::format("has an edge that {} facets share", sharers.size()),
                        "a surface has one or two facets along an edge; repair the mesh");
    if (sharers.size() == 2 && sharers[0].second == sharers[1].second)
      throw input_error(path, 0, facet,
                        fmt::format("and its neighbour, facet {}, face opposite sides", sharers[1].first + 1),
                        "flip one of them: corners must turn counter-clockwise seen from outside everywhere");
    if (sharers.size() == 1 && !mesh.open)
      throw input_error(path, 0, facet, "has an edge without a neighbour: the mesh has a hole",
                        "close it, or say open = true");
  }
}

/// Six times the volume that a closed surface holds; negative when its facets face inward.
double signed_volume(const Facets& facets) {
  double sum = 0;
  for (const auto& f : facets) sum += dot(f[0] - facets[0][0], cross(f[1] - facets[0][0], f[2] - facets[0][0]));
  return sum;
}

}  // namespace

void read_mesh_file(MeshSpec& mesh, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / mesh.path).string();
  mesh.facets = read_facets(path);
  if (mesh.facets.empty()) throw damaged(path, "it holds no facets");
  for (auto& f : mesh.facets)
    for (Vec3& x : f) {
      x = mesh.scale * x + mesh.offset;
      if (!std::isfinite(x.x + x.y + x.z)) throw damaged(path, "a corner is not finite");
    }
  const auto corner = join_corners(mesh.facets, 1e-6 * size_of(mesh.facets) + 1e-300);
  check_surface(mesh, corner, path);
  if (!mesh.open && signed_volume(mesh.facets) < 0)
    throw input_error(path, 0, "the mesh", "faces inward everywhere",
                      "flip its facets: corners must turn counter-clockwise seen from outside");
}

}  // namespace eg
