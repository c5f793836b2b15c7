#include "io/vtk.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "io/text_file.hpp"
#include "measure/force_network.hpp"

namespace eg {

namespace {

static_assert(std::endian::native == std::endian::little);

/// The appended section: every array is a byte count, then its bytes; the XML names where each one starts.
class Appended {
 public:
  /// The XML element of an array and its bytes into the section.
  template <class T>
  std::string array(const char* type, const char* name, int components, const std::vector<T>& data) {
    const auto offset = bytes_.size();
    const std::uint64_t size = data.size() * sizeof(T);
    append(&size, sizeof size);
    append(data.data(), size);
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type,
        name, components, offset);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string bytes_;
};

void push(std::vector<double>& all, const Vec3& v) { all.insert(all.end(), {v.x, v.y, v.z}); }

/// A file of one kind of data: the XML of its piece, and the appended section behind it.
void write_data(const std::string& path, const std::string& type, const std::string& attributes,
                const std::string& piece, const Appended& data) {
  write_file(path, fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" "
                               "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<{0}{1}>\n{2}</Piece>\n</{0}>\n"
                               "<AppendedData encoding=\"raw\">\n_",
                               type, attributes, piece) +
                       data.bytes() + "\n</AppendedData>\n</VTKFile>\n");
}

void write_piece(const std::string& path, const std::string& piece, const Appended& data) {
  write_data(path, "PolyData", "", piece, data);
}

}  // namespace

void write_vtp(const std::string& path, const State& state, std::span<const GrainField> fields) {
  const auto& grains = state.grains;
  const std::size_t n = grains.size();
  std::vector<double> point, radius, velocity;
  std::vector<std::int64_t> connectivity, offset;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 x = grains.position[i].vec();
    push(point, x);
    push(velocity, grains.velocity[i].vec() + state.cell.rate * x);
    radius.push_back(grains.radius(i));
    connectivity.push_back(static_cast<std::int64_t>(i));
    offset.push_back(static_cast<std::int64_t>(i) + 1);
  }
  Appended data;
  std::string xml =
      fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\">\n<PointData Scalars=\"radius\">\n", n);
  xml += data.array("Float64", "radius", 1, radius);
  xml += data.array("Float64", "velocity", 3, velocity);
  xml += data.array("UInt32", "id", 1, grains.id);
  for (const auto& field : fields) xml += data.array("Float64", field.name.c_str(), field.components, field.data);
  xml += "</PointData>\n<Points>\n" + data.array("Float64", "position", 3, point) + "</Points>\n<Verts>\n";
  xml += data.array("Int64", "connectivity", 1, connectivity) + data.array("Int64", "offsets", 1, offset);
  write_piece(path, xml + "</Verts>\n", data);
}

void write_network_vtp(const std::string& path, const State& state, std::span<const ContactPoint> contacts,
                       const ForceChains& chains) {
  double mean = 0;
  for (const auto& c : contacts) mean += c.normal.force / static_cast<double>(contacts.size());
  std::vector<double> point, force, normal, shear;
  std::vector<std::int32_t> strong, sliding;
  std::vector<std::int64_t> connectivity, offset;
  for (const auto& c : contacts) {
    const Vec3 x = state.grains.position[c.i].vec();
    push(point, x), push(point, x + c.branch);
    for (int end = 0; end < 2; ++end) connectivity.push_back(static_cast<std::int64_t>(connectivity.size()));
    offset.push_back(static_cast<std::int64_t>(connectivity.size()));
    push(force, c.force());
    normal.push_back(c.normal.force), shear.push_back(norm(c.shear));
    strong.push_back(is_strong(c, mean)), sliding.push_back(c.sliding());
  }
  Appended data;
  std::string xml = fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfLines=\"{}\">\n<Points>\n", 2 * contacts.size(),
                                contacts.size());
  xml += data.array("Float64", "position", 3, point) + "</Points>\n<Lines>\n";
  xml += data.array("Int64", "connectivity", 1, connectivity) + data.array("Int64", "offsets", 1, offset);
  xml += "</Lines>\n<CellData Scalars=\"normal_force\">\n";
  xml += data.array("Float64", "normal_force", 1, normal) + data.array("Float64", "shear_force", 1, shear);
  xml += data.array("Float64", "force", 3, force) + data.array("Int32", "strong", 1, strong);
  xml += data.array("Int32", "sliding", 1, sliding) + data.array("Int32", "chain", 1, chains.link);
  write_piece(path, xml + "</CellData>\n", data);
}

void write_vti(const std::string& path, const ZoneGrid& grid, const ZoneTable& table) {
  const std::array n{grid.zones(0), grid.zones(1), grid.zones(2)};
  std::vector<double> void_ratio, solid;
  std::vector<std::int64_t> particles;
  for (std::size_t c = 0; c < n[2]; ++c)
    for (std::size_t b = 0; b < n[1]; ++b)
      for (std::size_t a = 0; a < n[0]; ++a) {
        const ZoneMeasures& zone = table.zones[(a * n[1] + b) * n[2] + c];
        void_ratio.push_back(zone.solid > 0 ? zone.void_ratio() : std::numeric_limits<double>::quiet_NaN());
        solid.push_back(zone.solid_fraction());
        particles.push_back(static_cast<std::int64_t>(zone.grains));
      }
  const auto spacing = [&](std::size_t k) {
    return (grid.edges[k].back() - grid.edges[k].front()) / static_cast<double>(n[k]);
  };
  const auto extent = fmt::format("0 {} 0 {} 0 {}", n[0], n[1], n[2]);
  Appended data;
  std::string xml = fmt::format("<Piece Extent=\"{}\">\n<CellData Scalars=\"void_ratio\">\n", extent);
  xml += data.array("Float64", "void_ratio", 1, void_ratio) + data.array("Float64", "solid_fraction", 1, solid);
  xml += data.array("Int64", "particles", 1, particles) + "</CellData>\n";
  write_data(path, "ImageData",
             fmt::format(" WholeExtent=\"{}\" Origin=\"{:.17g} {:.17g} {:.17g}\" Spacing=\"{:.17g} {:.17g} {:.17g}\"",
                         extent, grid.edges[0].front(), grid.edges[1].front(), grid.edges[2].front(), spacing(0),
                         spacing(1), spacing(2)),
             xml, data);
}

}  // namespace eg
