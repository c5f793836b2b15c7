#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "base/random.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "io/snapshot_fields.hpp"
#include "io/text_file.hpp"
#include "scratch.hpp"

namespace {

const char* text = R"(dimension = 3
material.quartz = { density = 2650, friction = 0.5, shear_modulus = 29e9, poisson = 0.12 }
material.steel = { density = 7800, friction = 0.1, shear_modulus = 80e9, poisson = 0.3 }
contact.law = "hertz-mindlin"
specimen = { source = "cloud", count = 30, grading = "toyoura" }
boundary = { type = "box", wall_material = "steel" }
)";

/// Every number of the state from a random stream, within what a reader accepts.
class Scramble {
 public:
  void value(const std::string&, const std::string&, auto& x) { fill(x); }
  void array(const std::string& name, const std::string&, auto& all) {
    if (name == "friction") all.resize(4);
    for (auto& x : all) fill(x);
  }
  void column(const std::string&, const std::string&, auto& all, auto field) {
    for (auto& x : all) fill_field(field(x));
  }
  void history(const std::string&, const std::string&, eg::Contacts& contacts) {
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t k = 0; k < contacts.history_size; ++k) contacts.history_at(c, k) = number();
  }

 private:
  double number() { return random_.uniform() * 3 - 0x1p-60; }
  void fill_field(auto&& x) {
    if constexpr (requires { x.quad; }) {
      x.quad.x = number(), x.quad.y = -number(), x.quad.z = number() * 1e-300;
    } else {
      fill(x);
    }
  }
  void fill(double& x) { x = number(); }
  void fill(float& x) { x = static_cast<float>(random_.normal()); }
  void fill(bool& x) { x = random_.uniform() < 0.5; }
  template <std::integral T>
  requires(!std::same_as<T, bool>) void fill(T& x) { x = static_cast<T>(random_.below(2)); }
  void fill(eg::Vec3& v) { v = {number(), -number(), 1e200 * number()}; }
  void fill(eg::Mat3& m) {
    for (double& x : m.a) x = number();
  }
  template <class T, std::size_t N>
  void fill(std::array<T, N>& all) {
    for (T& x : all) fill(x);
  }

  eg::Random random_{42};
};

eg::State scrambled_state() {
  eg::State s;
  s.grains.position.resize(30);
  s.grains.velocity.resize(30);
  s.grains.spin.resize(30);
  s.grains.id.resize(30);
  s.grains.material.resize(30);
  s.contacts.i.resize(19);
  s.contacts.j.resize(19);
  s.contacts.image.resize(19);
  s.contacts.history_size = 3;
  s.contacts.history.resize(24 * 3);
  s.list.j.resize(50);
  s.list.image.resize(50);
  s.list.reference.resize(30);
  s.bodies.resize(6);
  s.walls.resize(2);
  s.spokes.resize(2);
  s.glued.resize(2);
  s.wall_contacts.resize(3);
  s.policy.bound.overlap.resize(19);
  s.policy.bound.weight.resize(19);
  s.policy.bound.wall_overlap.resize(3);
  s.policy.bound.grain.resize(30);
  Scramble scramble;
  eg::visit_state(scramble, s);
  s.contacts.chunk_begin = {0, 8, 19};
  s.list.begin.assign(31, 50);
  s.list.begin[0] = 0;
  s.dimension = 3;
  s.stage = 0;
  s.step = (1ull << 60) + 1;
  return s;
}

/// The bytes of every field in order, so that two states can be compared bit for bit.
class Bytes {
 public:
  std::string all;
  void value(const std::string&, const std::string&, const auto& x) { add(x); }
  void array(const std::string&, const std::string&, const auto& values) {
    add(values.size());
    for (const auto& x : values) add(x);
  }
  void column(const std::string&, const std::string&, const auto& values, auto field) {
    add(values.size());
    for (const auto& x : values) {
      auto&& part = field(x);
      if constexpr (requires { part.quad; })
        add(part.quad.vec());
      else
        add(part);
    }
  }
  void history(const std::string&, const std::string&, const eg::Contacts& contacts) {
    add(contacts.history_size);
    for (const double x : contacts.history) add(x);
  }

 private:
  void add(const auto& x) { all.append(reinterpret_cast<const char*>(&x), sizeof x); }
};

std::string bytes_of(const eg::State& state) {
  Bytes bytes;
  eg::visit_state(bytes, state);
  return bytes.all;
}

TEST(Snapshot, StateComesBackBitForBit) {
  const Scratch scratch;
  const std::string path = scratch / "state.h5";
  const auto scene = eg::parse_scene(text, "dir/a.toml");
  const auto state = scrambled_state();
  eg::write_snapshot(path, scene, state);
  const auto read = eg::read_snapshot(path);
  EXPECT_EQ(bytes_of(read.state), bytes_of(state));
  EXPECT_EQ(read.scene.text, text);
  EXPECT_EQ(read.scene.file, "dir/a.toml");
  EXPECT_EQ(read.scene.materials[1].name, "steel");
  EXPECT_EQ(read.state.contacts.history.size(), state.contacts.history.size());

  auto other = state;  // the comparison sees every bit
  other.cell.strain(2, 2) = std::nextafter(other.cell.strain(2, 2), 9.0);
  EXPECT_NE(bytes_of(other), bytes_of(state));
}

TEST(Snapshot, SparseStateComesBack) {
  const Scratch scratch;
  const std::string path = scratch / "state.h5";
  auto state = scrambled_state();
  state.grains.spin.clear();
  state.grains.material.clear();
  state.contacts = {};
  state.walls.clear();
  state.wall_contacts.clear();
  state.policy = {};
  state.ledger.body = -0.0;
  eg::write_snapshot(path, eg::parse_scene(text), state);
  const auto read = eg::read_snapshot(path).state;
  EXPECT_EQ(bytes_of(read), bytes_of(state));
  EXPECT_FALSE(read.grains.rotates());
}

TEST(Snapshot, APlanOfTheStepThatMissesContactsIsRefused) {
  const Scratch scratch;
  const std::string path = scratch / "state.h5";
  auto state = scrambled_state();
  state.policy.bound.overlap.pop_back();
  eg::write_snapshot(path, eg::parse_scene(text), state);
  EXPECT_THROW(eg::read_snapshot(path), eg::InputError);
}

TEST(Snapshot, SameStateGivesTheSameFileAndLeavesNoOther) {
  const Scratch scratch;
  const auto scene = eg::parse_scene(text);
  for (const char* name : {"a.h5", "b.h5", "b.h5"}) eg::write_snapshot(scratch / name, scene, scrambled_state());
  EXPECT_EQ(eg::read_file(scratch / "a.h5"), eg::read_file(scratch / "b.h5"));
  EXPECT_TRUE(eg::looks_like_snapshot(scratch / "a.h5"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.folder()), {}), 2);
}

TEST(Snapshot, AFailedWriteLeavesTheOldFile) {
  const Scratch scratch;
  const std::string path = scratch / "state.h5";
  const auto scene = eg::parse_scene(text);
  const auto state = scrambled_state();
  eg::write_snapshot(path, scene, state);
  std::filesystem::create_directory(path + ".part");  // the temporary file cannot be made
  EXPECT_THROW(eg::write_snapshot(path, scene, eg::State{}), eg::RunError);
  EXPECT_EQ(bytes_of(eg::read_snapshot(path).state), bytes_of(state));
}

}  // namespace
