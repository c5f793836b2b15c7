#pragma once
// As much of HDF5 as a snapshot needs: datasets of numbers with a unit, texts, and one-line errors.
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace eg {

using Hdf5Id = std::int64_t;  ///< hid_t; hdf5.h itself stays in the .cpp

/// Owns one HDF5 identifier.
class Hdf5Handle {
 public:
  using Closer = int (*)(Hdf5Id);
  Hdf5Handle(Hdf5Id id, Closer close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  bool valid() const { return id_ >= 0; }
  operator Hdf5Id() const { return id_; }
  /// Closes now; false when that fails, as it does when buffered data cannot be written.
  bool close() { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  Hdf5Id id_;
  Closer close_;
};

/// HDF5's type of a number, the same in memory and in the file: double, int, uint8, uint16, uint32, uint64.
template <class T>
Hdf5Id hdf5_type();

using Hdf5Shape = std::vector<unsigned long long>;  ///< empty: a single number

/// Some rows of an array, in this order: {first, how many} each.
using Hdf5Rows = std::vector<std::array<unsigned long long, 2>>;

/// A file that is written once, from empty. Groups in dataset names ("grains/radius") are made as needed.
class Hdf5Writer {
 public:
  /// `shown` is the name for messages. Throws RunError when the file cannot be made or written, as every member does.
  Hdf5Writer(const std::string& path, std::string shown);
  template <class T>
  void write(const std::string& name, const std::string& unit, const Hdf5Shape& shape, const std::vector<T>& data) {
    write(name, unit, shape, hdf5_type<T>(), data.data());
  }
  void write_text(const std::string& name, const std::string& text);
  void close();

 private:
  void write(const std::string& name, const std::string& unit, const Hdf5Shape&, Hdf5Id type, const void* data);
  void require(bool success) const;

  std::string shown_;
  Hdf5Handle file_;
};

/// A file to read. Throws InputError when it is missing, foreign or damaged.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& path);
  /// Whether the file begins as HDF5 files do.
  static bool recognises(const std::string& path);
  bool has(const std::string& name) const;
  /// The numbers of a dataset, which must be of type T; their shape goes to `shape`.
  template <class T>
  std::vector<T> read(const std::string& name, Hdf5Shape& shape) const {
    const Hdf5Handle set = open(name, hdf5_type<T>(), shape);
    std::size_t size = 1;
    for (const auto edge : shape) size *= edge;
    std::vector<T> data(size);
    read(set, name, hdf5_type<T>(), data.data());
    return data;
  }
  /// The same of some rows only (first index); nothing else is read. `shape` becomes that of what was read.
  template <class T>
  std::vector<T> read_rows(const std::string& name, const Hdf5Rows& rows, Hdf5Shape& shape) const {
    const Hdf5Handle set = open(name, hdf5_type<T>(), shape);
    std::size_t width = 1, count = 0;
    for (std::size_t k = 1; k < shape.size(); ++k) width *= shape[k];
    for (const auto& run : rows) count += run[1];
    std::vector<T> data(width * count);
    T* next = data.data();
    for (const auto& run : rows) {
      read_run(set, name, hdf5_type<T>(), shape, run, next);
      next += width * run[1];
    }
    shape.at(0) = count;
    return data;
  }
  /// Number of rows of an array.
  unsigned long long rows(const std::string& name) const;
  std::string read_text(const std::string& name) const;
  /// Throw InputError "path: has no dataset name: …", "path: is damaged: … of dataset name".
  [[noreturn]] void missing(const std::string& name) const;
  [[noreturn]] void damaged(const std::string& name, const std::string& fault) const;

 private:
  Hdf5Handle open(const std::string& name, Hdf5Id type, Hdf5Shape& shape) const;
  void read(const Hdf5Handle& set, const std::string& name, Hdf5Id type, void* data) const;
  void read_run(const Hdf5Handle& set, const std::string& name, Hdf5Id type, Hdf5Shape shape,
                const std::array<unsigned long long, 2>& run, void* data) const;

  std::string path_;
  Hdf5Handle file_;
};

}  // namespace eg
