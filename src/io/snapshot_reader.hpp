#pragma once
// Reads the fields listed in snapshot_fields.hpp: of arrays all rows, or those that are selected. Private to io.
#include <fmt/format.h>

#include <functional>
#include <map>
#include <type_traits>

#include "io/hdf5_file.hpp"
#include "io/snapshot_fields.hpp"

namespace eg {

inline constexpr int snapshot_version = 1;

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

inline constexpr auto itself = [](auto& x) -> auto& { return x; };

class SnapshotReader {
 public:
  /// Chooses rows of an array by its name and its number of rows.
  using Select = std::function<Hdf5Rows(const std::string& name, unsigned long long rows)>;

  explicit SnapshotReader(const Hdf5Reader& file, Select select = {}) : file_(file), select_(std::move(select)) {}

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
    const auto data = read<Stored<Field>>(name, shape);
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
    const auto data = read<double>(name, shape);
    if (shape.size() != 2 || shape[0] != contacts.size()) file_.damaged(name, "is of another shape than expected");
    contacts.history_size = shape[1];
    constexpr auto lanes = Contacts::lanes;
    contacts.history.assign((contacts.size() + lanes - 1) / lanes * lanes * contacts.history_size, 0.0);
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t k = 0; k < contacts.history_size; ++k)
        contacts.history_at(c, k) = data[c * contacts.history_size + k];
  }

 private:
  template <class T>
  std::vector<T> read(const std::string& name, Hdf5Shape& shape) const {
    if (!select_) return file_.read<T>(name, shape);
    return file_.read_rows<T>(name, select_(name, file_.rows(name)), shape);
  }

  const Hdf5Reader& file_;
  Select select_;
  std::map<const void*, std::size_t> rows_;  ///< rows of the vectors that columns have been read into
};

/// Throws InputError unless the file is a snapshot of this format version.
void check_snapshot_format(const Hdf5Reader& file, const std::string& path);

}  // namespace eg
