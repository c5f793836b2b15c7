#include "io/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <type_traits>

#include "base/error.hpp"

namespace eg {

static_assert(std::is_same_v<hid_t, Hdf5Id> && std::is_same_v<hsize_t, Hdf5Shape::value_type>);

template <>
Hdf5Id hdf5_type<double>() {
  return H5T_IEEE_F64LE;
}
template <>
Hdf5Id hdf5_type<float>() {
  return H5T_IEEE_F32LE;
}
template <>
Hdf5Id hdf5_type<int>() {
  return H5T_STD_I32LE;
}
template <>
Hdf5Id hdf5_type<std::uint8_t>() {
  return H5T_STD_U8LE;
}
template <>
Hdf5Id hdf5_type<std::uint16_t>() {
  return H5T_STD_U16LE;
}
template <>
Hdf5Id hdf5_type<std::uint32_t>() {
  return H5T_STD_U32LE;
}
template <>
Hdf5Id hdf5_type<std::uint64_t>() {
  return H5T_STD_U64LE;
}

namespace {

/// HDF5 prints its errors by itself unless told not to; here every error becomes an exception.
class Quiet {
 public:
  Quiet() {
    H5dont_atexit();  // every handle is closed here; HDF5's own closing at exit complains about files it could not open
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

Hdf5Handle text_type(std::size_t size) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, size);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

Hdf5Handle create_file(const std::string& path) {
  const Quiet quiet;
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
}

Hdf5Handle open_file(const std::string& path) {
  const Quiet quiet;
  if (std::error_code ignored; !std::filesystem::exists(path, ignored))
    throw input_error(path, 0, "cannot be opened", "(No such file or directory)", "check the path");
  if (std::error_code ignored; std::filesystem::file_size(path, ignored) == 0)
    throw input_error(path, 0, "is an empty file:", "it holds no bytes", "name a .h5 file that a run has written");
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw input_error(path, 0, "is no snapshot:", "it is not an HDF5 file", "name a .h5 file that a run has written");
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid())
    throw input_error(path, 0, "is damaged:", "HDF5 cannot open it, it may have been cut short",
                      "use another snapshot");
  return file;
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::string& path, std::string shown)
    : shown_(std::move(shown)), file_(create_file(path)) {
  require(file_.valid());
}

void Hdf5Writer::require(bool success) const {
  if (!success) throw RunError(shown_ + ": cannot be written; check that the folder exists and has room");
}

void Hdf5Writer::write(const std::string& name, const std::string& unit, const Hdf5Shape& shape, hid_t type,
                       const void* data) {
  const Quiet quiet;
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);  // the same state gives the same bytes
  const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle space(
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      H5Sclose);
  const Hdf5Handle set(H5Dcreate2(file_, name.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose);
  require(set.valid() && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  if (unit.empty()) return;
  const Hdf5Handle text = text_type(unit.size());
  const Hdf5Handle attribute(H5Acreate2(set, "unit", text, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(attribute.valid() && H5Awrite(attribute, text, unit.data()) >= 0);
}

void Hdf5Writer::write_text(const std::string& name, const std::string& text) {
  write(name, "", {}, text_type(text.size()), text.data());
}

void Hdf5Writer::close() {
  const Quiet quiet;
  require(file_.close());
}

Hdf5Reader::Hdf5Reader(const std::string& path) : path_(path), file_(open_file(path)) {}

bool Hdf5Reader::recognises(const std::string& path) {
  const Quiet quiet;
  return H5Fis_hdf5(path.c_str()) > 0;
}

void Hdf5Reader::missing(const std::string& name) const {
  throw input_error(path_, 0, "has no dataset", name + ": an earlier eigengrain wrote it, or it is damaged",
                    "read it with the version that wrote it, or use another snapshot");
}

void Hdf5Reader::damaged(const std::string& name, const std::string& fault) const {
  throw input_error(path_, 0, "is damaged:", "dataset " + name + " " + fault, "use another snapshot");
}

bool Hdf5Reader::has(const std::string& name) const {
  const Quiet quiet;
  return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Handle Hdf5Reader::open(const std::string& name, hid_t type, Hdf5Shape& shape) const {
  const Quiet quiet;
  Hdf5Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) missing(name);
  const Hdf5Handle stored(H5Dget_type(set), H5Tclose);
  if (H5Tequal(stored, type) <= 0) damaged(name, "is of another type than expected");
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0) damaged(name, "has no shape");
  shape.assign(static_cast<std::size_t>(rank), 0);
  if (rank > 0) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  // A damaged header must not make us ask for more memory than the file can fill.
  hsize_t bytes = H5Tget_size(type);
  for (const auto edge : shape)
    if (__builtin_mul_overflow(bytes, edge, &bytes)) damaged(name, "has an impossible size");
  if (bytes > H5Dget_storage_size(set)) damaged(name, "is larger than what the file stores of it");
  return set;
}

void Hdf5Reader::read(const Hdf5Handle& set, const std::string& name, hid_t type, void* data) const {
  const Quiet quiet;
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) damaged(name, "cannot be read");
}

void Hdf5Reader::read_run(const Hdf5Handle& set, const std::string& name, hid_t type, Hdf5Shape shape,
                          const std::array<unsigned long long, 2>& run, void* data) const {
  const Quiet quiet;
  Hdf5Shape first(shape.size(), 0);
  first.at(0) = run[0], shape.at(0) = run[1];
  const Hdf5Handle file(H5Dget_space(set), H5Sclose);
  const Hdf5Handle memory(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  if (H5Sselect_hyperslab(file, H5S_SELECT_SET, first.data(), nullptr, shape.data(), nullptr) < 0 ||
      H5Dread(set, type, memory, file, H5P_DEFAULT, data) < 0)
    damaged(name, "cannot be read");
}

unsigned long long Hdf5Reader::rows(const std::string& name) const {
  const Quiet quiet;
  const Hdf5Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) missing(name);
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  Hdf5Shape shape(static_cast<std::size_t>(std::max(1, H5Sget_simple_extent_ndims(space))), 0);
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape[0];
}

std::string Hdf5Reader::read_text(const std::string& name) const {
  const Quiet quiet;
  const Hdf5Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.valid()) missing(name);
  const Hdf5Handle type(H5Dget_type(set), H5Tclose);
  const std::size_t size = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || size > H5Dget_storage_size(set))
    damaged(name, "is no text");
  std::string text(size, '\0');
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) damaged(name, "cannot be read");
  return text;
}

}  // namespace eg
