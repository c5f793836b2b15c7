#include <gtest/gtest.h>

#include <cstring>
#include <regex>

#include "io/text_file.hpp"
#include "io/vtk.hpp"
#include "scratch.hpp"

namespace {

/// The numbers of one appended array, found the way a reader finds them: by the offset that the XML names.
template <class T>
std::vector<T> values(const std::string& file, const std::string& name) {
  std::smatch found;
  const std::string xml = file.substr(0, file.find("<AppendedData"));
  if (!std::regex_search(xml, found, std::regex("Name=\"" + name + "\"[^>]* offset=\"([0-9]+)\""))) return {};
  const std::size_t start = file.find('_', file.find("<AppendedData")) + 1 + std::stoul(found[1]);
  std::uint64_t size = 0;
  std::memcpy(&size, file.data() + start, sizeof size);
  std::vector<T> data(size / sizeof(T));
  std::memcpy(data.data(), file.data() + start + sizeof size, size);
  return data;
}

TEST(Vtk, GrainsWithTrueVelocities) {
  eg::State state;
  state.cell.rate(0, 1) = 10;
  state.grains.position = {{1, 2, 3, 0.5}, {4, 5, 6, 0.25}};
  state.grains.velocity = {{0.1, 0, 0, 1}, {0, 0.2, 0, 1}};
  state.grains.id = {7, 9};
  const Scratch scratch;
  const std::string path = scratch / "grains.vtp";
  eg::write_vtp(path, state);
  const std::string file = eg::read_file(path);

  EXPECT_NE(file.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\""), std::string::npos);
  EXPECT_EQ(values<double>(file, "position"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(values<double>(file, "radius"), (std::vector{0.5, 0.25}));
  EXPECT_EQ(values<double>(file, "velocity"), (std::vector<double>{20.1, 0, 0, 50, 0.2, 0}));
  EXPECT_EQ(values<std::uint32_t>(file, "id"), (std::vector<std::uint32_t>{7, 9}));
  EXPECT_EQ(values<std::int64_t>(file, "offsets"), (std::vector<std::int64_t>{1, 2}));
}

TEST(Vtk, ContactsAsLinesWithTheirForces) {
  eg::State state;
  state.grains.position = {{0, 0, 0, 1}, {0, 0, 2, 1}, {9, 0, 0, 1}};
  eg::ContactPoint a, b;
  a.i = 0, a.j = 1, a.branch = {0, 0, 2}, a.geometry.n = {0, 0, 1}, a.normal.force = 3, a.shear = {1, 0, 0};
  b.i = 2, b.j = 0, b.branch = {1, 0, 0}, b.geometry.n = {1, 0, 0}, b.normal.force = 1, b.limit = 1;  // to an image
  a.limit = 1;
  eg::ForceChains chains;
  chains.link = {0, eg::ForceChains::none};
  const Scratch scratch;
  const std::string path = scratch / "contacts.vtp";
  eg::write_network_vtp(path, state, std::vector{a, b}, chains);
  const std::string file = eg::read_file(path);
  EXPECT_NE(file.find("NumberOfPoints=\"4\" NumberOfLines=\"2\""), std::string::npos);
  EXPECT_EQ(values<double>(file, "position"), (std::vector<double>{0, 0, 0, 0, 0, 2, 9, 0, 0, 10, 0, 0}));
  EXPECT_EQ(values<std::int64_t>(file, "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(values<std::int64_t>(file, "offsets"), (std::vector<std::int64_t>{2, 4}));
  EXPECT_EQ(values<double>(file, "normal_force"), (std::vector<double>{3, 1}));
  EXPECT_EQ(values<double>(file, "force"), (std::vector<double>{-1, 0, 3, 1, 0, 0}));
  EXPECT_EQ(values<std::int32_t>(file, "strong"), (std::vector<std::int32_t>{1, 0}));
  EXPECT_EQ(values<std::int32_t>(file, "sliding"), (std::vector<std::int32_t>{1, 0}));
  EXPECT_EQ(values<std::int32_t>(file, "chain"), (std::vector<std::int32_t>{0, -1}));
}

}  // namespace
