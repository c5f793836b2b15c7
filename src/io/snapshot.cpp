#include "io/snapshot.hpp"

#include <fmt/format.h>

#include <map>
#include <type_traits>

#include "base/error.hpp"
#include "base/version.hpp"
#include "io/hdf5_file.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot_fields.hpp"
#include "io/state_check.hpp"
#include "io/text_file.hpp"

namespace eg {

namespace {

constexpr int format_version = 1;

/// How a field is stored: as `width` numbers of type Number, found by at(field, k).
template <class T>
struct Parts {
  static_assert(std::is_arithmetic_v<T>);
  using Number = T;
  static constexpr std::size_t width = 1;
  static auto& at(auto& x, std::size_t) { return x; }
};
template <class S>
struct Parts<Vec<S>> {
  using Number = S;
  static constexpr std::size_t width = 3;
  static auto& at(auto& x, std::size_t k) { return x[static_cast<int>(k)]; }
};
template <class S>
struct Parts<Mat<S>> {
  using Number = S;
  static constexpr std::size_t width = 9;
  static auto& at(auto& x, std::size_t k) { return x.a[k]; }
};
template <class S, std::size_t N>
struct Parts<std::array<S, N>> {
  using Number = S;
  static constexpr std::size_t width = N;
  static auto& at(auto& x, std::size_t k) { return x[k]; }
};
template <class Q>
struct Parts<VectorPart<Q>> {
  using Number = double;
  static constexpr std::size_t width = 3;
  static auto& at(auto&& x, std::size_t k) { return k == 0 ? x.quad.x : k == 1 ? x.quad.y : x.quad.z; }
};

template <class T>
using PartsOf = Parts<std::remove_cvref_t<T>>;
/// Type of a number in the file: bool becomes a byte.
template <class T>
using Stored =
    std::conditional_t<std::is_same_v<typename PartsOf<T>::Number, bool>, std::uint8_t, typename PartsOf<T>::Number>;

/// Shape of one field beside the number of rows: nothing for a number, 3×3 for a matrix.
template <class T>
void add_shape(Hdf5Shape& shape) {
  if constexpr (PartsOf<T>::width == 9)
    shape.insert(shape.end(), {3, 3});
  else if constexpr (PartsOf<T>::width > 1)
    shape.push_back(PartsOf<T>::width);
}

constexpr auto itself = [](auto& x) -> auto& { return x; };

class Writer {
 public:
  explicit Writer(Hdf5Writer& file) : file_(file) {}

  template <class T>
  void value(const std::string& name, const std::string& unit, const T& x) {
    using P = PartsOf<T>;
    std::vector<Stored<T>> data(P::width);
    for (std::size_t k = 0; k < P::width; ++k) data[k] = static_cast<Stored<T>>(P::at(x, k));
    Hdf5Shape shape;
    add_shape<T>(shape);
    file_.write(name, unit, shape, data);
  }
  template <class T>
  void array(const std::string& name, const std::string& unit, const std::vector<T>& all) {
    column(name, unit, all, itself);
  }
  template <class T, class Project>
  void column(const std::string& name, const std::string& unit, const std::vector<T>& all, Project field) {
    using Field = decltype(field(all[0]));
    using P = PartsOf<Field>;
    std::vector<Stored<Field>> data(all.size() * P::width);
    for (std::size_t i = 0; i < all.size(); ++i) {
      auto&& x = field(all[i]);
      for (std::size_t k = 0; k < P::width; ++k) data[i * P::width + k] = P::at(x, k);
    }
    Hdf5Shape shape{all.size()};
    add_shape<Field>(shape);
    file_.write(name, unit, shape, data);
  }
  void history(const std::string& name, const std::string& unit, const Contacts& contacts) {
    std::vector<double> data;
    data.reserve(contacts.size() * contacts.history_size);
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t k = 0; k < contacts.history_size; ++k) data.push_back(contacts.history_at(c, k));
    file_.write(name, unit, {contacts.size(), contacts.history_size}, data);
  }

 private:
  Hdf5Writer& file_;
};

class Reader {
 public:
  explicit Reader(const Hdf5Reader& file) : file_(file) {}

  template <class T>
  void value(const std::string& name, const std::string&, T& x) {
    using P = PartsOf<T>;
    Hdf5Shape shape, expected;
    add_shape<T>(expected);
    const auto data = file_.read<Stored<T>>(name, shape);
    if (shape != expected) file_.damaged(name, "is of another shape than expected");
    for (std::size_t k = 0; k < P::width; ++k) P::at(x, k) = static_cast<typename P::Number>(data[k]);
  }
  template <class T>
  void array(const std::string& name, const std::string& unit, std::vector<T>& all) {
    column(name, unit, all, itself);
  }
  template <class T, class Project>
  void column(const std::string& name, const std::string&, std::vector<T>& all, Project field) {
    using Field = decltype(field(all[0]));
    using P = PartsOf<Field>;
    Hdf5Shape shape;
    const auto data = file_.read<Stored<Field>>(name, shape);
    const std::size_t rows = shape.empty() ? 0 : shape[0];
    Hdf5Shape expected{rows};
    add_shape<Field>(expected);
    if (shape != expected) file_.damaged(name, "is of another shape than expected");
    if (const auto [seen, first] = rows_.emplace(&all, rows); !first && seen->second != rows)
      file_.damaged(name, fmt::format("has {} rows, not {}", rows, seen->second));
    all.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      auto&& x = field(all[i]);
      for (std::size_t k = 0; k < P::width; ++k) P::at(x, k) = static_cast<typename P::Number>(data[i * P::width + k]);
    }
  }
  void history(const std::string& name, const std::string&, Contacts& contacts) {
    Hdf5Shape shape;
    const auto data = file_.read<double>(name, shape);
    if (shape.size() != 2 || shape[0] != contacts.size()) file_.damaged(name, "is of another shape than expected");
    contacts.history_size = shape[1];
    constexpr auto lanes = Contacts::lanes;
    contacts.history.assign((contacts.size() + lanes - 1) / lanes * lanes * contacts.history_size, 0.0);
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t k = 0; k < contacts.history_size; ++k)
        contacts.history_at(c, k) = data[c * contacts.history_size + k];
  }

 private:
  const Hdf5Reader& file_;
  std::map<const void*, std::size_t> rows_;  ///< rows of the vectors that columns have been read into
};

void check_format(const Hdf5Reader& file, const std::string& path) {
  if (!file.has("format_version"))
    throw input_error(path, 0, "is no snapshot:", "it is an HDF5 file of another program",
                      "name a .h5 file that a run has written");
  int version = 0;
  Reader(file).value("format_version", "", version);
  if (version != format_version)
    throw input_error(path, 0, fmt::format("format_version = {}", version),
                      fmt::format("must be {} for eigengrain {}", format_version, eg::version()),
                      "read it with the version that wrote it, " + file.read_text("program_version"));
}

}  // namespace

void write_snapshot(const std::string& path, const Scene& scene, const State& state) {
  if (scene.text.empty()) throw RunError(path + ": cannot be written, since the scene has no text to store");
  replace_file(path, [&](const std::string& temporary) {
    Hdf5Writer file(temporary, path);
    Writer writer(file);
    writer.value("format_version", "", format_version);
    file.write_text("program_version", version());
    file.write_text("scene/file", scene.file);
    file.write_text("scene/text", scene.text);
    visit_state(writer, state);
    file.close();
  });
}

Snapshot read_snapshot(const std::string& path) {
  const Hdf5Reader file(path);
  check_format(file, path);
  Snapshot snapshot{parse_scene(file.read_text("scene/text"), file.read_text("scene/file")), {}};
  Reader reader(file);
  visit_state(reader, snapshot.state);
  check_state(snapshot.scene, snapshot.state, path);
  return snapshot;
}

bool looks_like_snapshot(const std::string& path) { return Hdf5Reader::recognises(path); }

}  // namespace eg
