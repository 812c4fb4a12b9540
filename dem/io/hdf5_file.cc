#include "dem/io/hdf5_file.h"

#include <hdf5.h>

#include <type_traits>

#include "base/check.h"

namespace densify::dem {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));
static_assert(sizeof(Vec3) == 3 * sizeof(double));

namespace {

/// The innermost message of the library's error stack.
std::string cause() {
  std::string text;
  auto first = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
    *static_cast<std::string*>(out) = error->desc ? error->desc : "";
    return 1;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &text);
  return text.empty() ? "HDF5 gives no reason" : text;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& action) {
  throw FileError(path.string() + ": cannot " + action + " (" + cause() + ")");
}

/// Failures become exceptions; the library's own printing is switched off.
void silence() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

template <class T>
hid_t native() {
  if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return H5T_NATIVE_UINT8;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return H5T_NATIVE_UINT32;
  else {
    static_assert(std::is_same_v<T, std::uint64_t>);
    return H5T_NATIVE_UINT64;
  }
}

Hdf5Id text_type() {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

Hdf5Id memory_access() {
  Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  constexpr std::size_t increment = 1 << 20;
  H5Pset_fapl_core(access.get(), increment, false);
  return access;
}

}  // namespace

Hdf5Turn::Hdf5Turn() {
  static std::recursive_mutex library;
  turn_ = std::unique_lock(library);
}

Hdf5Reader::Hdf5Reader(std::filesystem::path path) : path_(std::move(path)) {
  silence();
  file_ = Hdf5Id(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file_.valid()) fail(path_, "read this HDF5 file");
}

Hdf5Reader::Hdf5Reader(std::filesystem::path path, std::string_view image) : path_(std::move(path)) {
  silence();
  const Hdf5Id access = memory_access();
  // The library copies the image and leaves ours alone.
  if (H5Pset_file_image(access.get(), const_cast<char*>(image.data()), image.size()) >= 0) {
    const std::string name = path_.string() + " in memory";  // of no file, or the library refuses the image
    file_ = Hdf5Id(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  }
  if (!file_.valid()) fail(path_, "read this HDF5 file");
}

bool Hdf5Reader::has(const std::string& name) const {
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    const std::string part = name.substr(0, slash);
    if (H5Lexists(file_.get(), part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (slash == std::string::npos) return H5Oexists_by_name(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
  }
}

bool Hdf5Reader::has_own(const std::string& name) const {
  H5L_info_t info;
  return has(name) && H5Lget_info(file_.get(), name.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_HARD;
}

Hdf5Shape Hdf5Reader::shape(const std::string& name) const {
  const Hdf5Id set(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Id space(set.valid() ? H5Dget_space(set.get()) : -1, H5Sclose);
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
  hsize_t extent[2] = {1, 1};
  if (rank < 0 || rank > 2 || H5Sget_simple_extent_dims(space.get(), extent, nullptr) < 0)
    fail(path_, "read dataset " + name);
  return {extent[0], extent[1]};
}

template <class T>
std::vector<T> Hdf5Reader::read(const std::string& name) const {
  const Hdf5Shape s = shape(name);
  const Hdf5Id set(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Id type(H5Dget_type(set.get()), H5Tclose);
  if (H5Tequal(type.get(), native<T>()) <= 0)
    throw FileError(path_.string() + ": dataset " + name + " holds another type of number than it should");
  std::vector<T> values(s.rows * s.columns);
  if (!values.empty() && H5Dread(set.get(), native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(path_, "read dataset " + name);
  return values;
}

template std::vector<double> Hdf5Reader::read(const std::string&) const;
template std::vector<std::uint8_t> Hdf5Reader::read(const std::string&) const;
template std::vector<std::uint32_t> Hdf5Reader::read(const std::string&) const;
template std::vector<std::uint64_t> Hdf5Reader::read(const std::string&) const;

std::vector<std::string> Hdf5Reader::texts(const std::string& name) const {
  const Hdf5Shape s = shape(name);
  const Hdf5Id set(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Id type = text_type(), space(H5Dget_space(set.get()), H5Sclose);
  std::vector<char*> raw(s.rows * s.columns, nullptr);
  if (!raw.empty() && H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.data()) < 0)
    fail(path_, "read text " + name);
  std::vector<std::string> values;
  for (const char* text : raw) values.emplace_back(text ? text : "");
  if (!raw.empty()) H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, raw.data());
  return values;
}

std::string Hdf5Reader::text(const std::string& name) const {
  const auto values = texts(name);
  if (values.size() != 1) throw FileError(path_.string() + ": " + name + " is not a single text");
  return values[0];
}

template <class T>
T Hdf5Reader::attribute(const std::string& object, const std::string& name) const {
  // By way of the object: H5Aopen_by_name through an external link takes texts from the heap of the linking file.
  const Hdf5Id o(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  const Hdf5Id a(o.valid() ? H5Aopen(o.get(), name.c_str(), H5P_DEFAULT) : -1, H5Aclose);
  const Hdf5Id space(a.valid() ? H5Aget_space(a.get()) : -1, H5Sclose);
  const std::string what = "read attribute " + name + " of " + object;
  if (!space.valid() || H5Sget_simple_extent_npoints(space.get()) != 1) fail(path_, what);
  if constexpr (std::is_same_v<T, std::string>) {
    const Hdf5Id type = text_type();
    char* raw = nullptr;
    if (H5Aread(a.get(), type.get(), &raw) < 0) fail(path_, what);
    const std::string value = raw ? raw : "";
    H5free_memory(raw);
    return value;
  } else {
    T value{};
    if (H5Aread(a.get(), native<T>(), &value) < 0) fail(path_, what);
    return value;
  }
}

template double Hdf5Reader::attribute(const std::string&, const std::string&) const;
template std::uint64_t Hdf5Reader::attribute(const std::string&, const std::string&) const;
template std::string Hdf5Reader::attribute(const std::string&, const std::string&) const;

Hdf5Writer::Hdf5Writer(std::filesystem::path path) : path_(std::move(path)) {
  silence();
  make_groups_ = Hdf5Id(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(make_groups_.get(), 1);
  no_times_ = Hdf5Id(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(no_times_.get(), false);  // the same content gives the same bytes
  const std::string name = path_.string() + " being written";
  file_ = Hdf5Id(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, memory_access().get()), H5Fclose);
  if (!file_.valid()) fail(path_, "write this file");
}

void Hdf5Writer::group(const std::string& name) {
  const Hdf5Id g(H5Gcreate2(file_.get(), name.c_str(), make_groups_.get(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!g.valid()) fail(path_, "write group " + name);
}

void Hdf5Writer::write(const std::string& name, const void* values, std::int64_t type, Hdf5Shape shape, int rank,
                       std::string_view unit) {
  const hsize_t extent[2] = {shape.rows, shape.columns};
  const Hdf5Id space(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, extent, nullptr), H5Sclose);
  const Hdf5Id set(
      H5Dcreate2(file_.get(), name.c_str(), type, space.get(), make_groups_.get(), no_times_.get(), H5P_DEFAULT),
      H5Dclose);
  if (!set.valid() ||
      (shape.rows * shape.columns > 0 && H5Dwrite(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0))
    fail(path_, "write dataset " + name);
  if (!unit.empty()) attribute(name, "unit", unit);
}

template <class T>
void Hdf5Writer::list(const std::string& name, const std::vector<T>& values, std::string_view unit) {
  write(name, values.data(), native<T>(), {values.size(), 1}, 1, unit);
}

template void Hdf5Writer::list(const std::string&, const std::vector<double>&, std::string_view);
template void Hdf5Writer::list(const std::string&, const std::vector<std::uint8_t>&, std::string_view);
template void Hdf5Writer::list(const std::string&, const std::vector<std::uint32_t>&, std::string_view);
template void Hdf5Writer::list(const std::string&, const std::vector<std::uint64_t>&, std::string_view);

void Hdf5Writer::table(const std::string& name, std::span<const double> values, std::size_t columns,
                       std::string_view unit) {
  write(name, values.data(), H5T_NATIVE_DOUBLE, {values.size() / columns, columns}, 2, unit);
}

void Hdf5Writer::table(const std::string& name, const std::vector<Vec3>& values, std::string_view unit) {
  write(name, values.data(), H5T_NATIVE_DOUBLE, {values.size(), 3}, 2, unit);
}

void Hdf5Writer::text(const std::string& name, std::string_view value) {
  const std::string copy(value);
  const char* raw = copy.c_str();
  write(name, &raw, text_type().get(), {1, 1}, 0, "");
}

void Hdf5Writer::texts(const std::string& name, const std::vector<std::string>& values) {
  std::vector<const char*> raw;
  for (const auto& v : values) raw.push_back(v.c_str());
  write(name, raw.data(), text_type().get(), {values.size(), 1}, 1, "");
}

void Hdf5Writer::write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                                 const void* value) {
  const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id a(H5Acreate_by_name(file_.get(), object.c_str(), name.c_str(), type, space.get(), H5P_DEFAULT,
                                   H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  if (!a.valid() || H5Awrite(a.get(), type, value) < 0) fail(path_, "write attribute " + name + " of " + object);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, double value) {
  write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::uint64_t value) {
  write_attribute(object, name, H5T_NATIVE_UINT64, &value);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::string_view value) {
  const std::string copy(value);
  const char* raw = copy.c_str();
  write_attribute(object, name, text_type().get(), &raw);
}

void Hdf5Writer::external_link(const std::string& name, const std::string& file, const std::string& object) {
  if (H5Lcreate_external(file.c_str(), object.c_str(), file_.get(), name.c_str(), make_groups_.get(), H5P_DEFAULT) < 0)
    fail(path_, "write link " + name);
}

void Hdf5Writer::copy(const Hdf5Reader& from, const std::string& source, const std::string& target) {
  if (H5Ocopy(from.id(), source.c_str(), file_.get(), target.c_str(), H5P_DEFAULT, make_groups_.get()) < 0)
    fail(path_, "copy " + source + " of " + from.path().string() + " to " + target);
}

std::string Hdf5Writer::image() {
  if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0) fail(path_, "write this file");
  const ssize_t size = H5Fget_file_image(file_.get(), nullptr, 0);
  std::string bytes(size > 0 ? std::size_t(size) : 0, '\0');
  if (size <= 0 || H5Fget_file_image(file_.get(), bytes.data(), bytes.size()) != size) fail(path_, "write this file");
  return bytes;
}

void Hdf5Writer::commit(Durability durability) {
  write_atomically(path_, {image()}, durability);
}

}  // namespace densify::dem
