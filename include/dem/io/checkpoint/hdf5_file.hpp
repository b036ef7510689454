#pragma once

// Columns in an HDF5 file. Needs the C library of HDF5: link dem::hdf5.

#include <dem/io/checkpoint/columns.hpp>
#include <dem/io/checkpoint/seal.hpp>
#include <dem/io/file.hpp>

#include <algorithm>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include <hdf5.h>

namespace dem::io {

namespace detail {

/// An object of HDF5, which is closed with it. Throws Error (`problem`) for an invalid one.
class Hdf5 {
 public:
  Hdf5(hid_t id, herr_t (*closer)(hid_t), const std::string& problem) : id_(id), close_(closer) {
    if (id < 0) throw Error(problem);
  }
  Hdf5(const Hdf5&) = delete;
  Hdf5& operator=(const Hdf5&) = delete;
  ~Hdf5() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT: it stands for it
  /// Closes it, and says whether that worked.
  bool close() { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its own errors to stderr; while this lives it does not. To be made before anything else of HDF5.
class QuietHdf5 {
 public:
  QuietHdf5() {
    // What could not be flushed to a full disk stays behind as a handle of freed memory, which HDF5 would close again
    // at the exit of the program, and crash. All files here are closed by then. A program that used HDF5 before keeps
    // what HDF5 does at its exit.
    [[maybe_unused]] static const herr_t never_at_exit = H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// How numbers lie in the file (little endian), and in memory.
inline hid_t type_in_file(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::real: return H5T_IEEE_F64LE;
    case ColumnKind::integer: return H5T_STD_I64LE;
    case ColumnKind::natural: return H5T_STD_U64LE;
    case ColumnKind::natural32: return H5T_STD_U32LE;
    case ColumnKind::byte:
    case ColumnKind::text: break;
  }
  return H5T_STD_U8LE;
}
inline hid_t type_in_memory(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::real: return H5T_NATIVE_DOUBLE;
    case ColumnKind::integer: return H5T_NATIVE_INT64;
    case ColumnKind::natural: return H5T_NATIVE_UINT64;
    case ColumnKind::natural32: return H5T_NATIVE_UINT32;
    case ColumnKind::byte:
    case ColumnKind::text: break;
  }
  return H5T_NATIVE_UINT8;
}

/// Texts (UTF-8) of a fixed length, padded with zeros: their bytes lie in the data set, where they are checksummed.
inline hid_t text_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

inline void write_attribute(hid_t object, const char* name, const std::string& value) {
  const std::string problem = std::string("cannot write the attribute ") + name;
  Hdf5 type(text_type(value.size()), H5Tclose, problem), space(H5Screate(H5S_SCALAR), H5Sclose, problem);
  Hdf5 attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, problem);
  if (H5Awrite(attribute, type, value.empty() ? "\0" : value.c_str()) < 0) throw Error(problem);
}
/// False if there is no such attribute.
inline bool read_attribute(hid_t object, const char* name, std::string& value) {
  if (H5Aexists(object, name) <= 0) return false;
  Hdf5 attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, "an attribute is damaged");
  Hdf5 type(H5Aget_type(attribute), H5Tclose, "an attribute is damaged");
  value.assign(H5Tget_size(type), '\0');
  if (H5Tis_variable_str(type) > 0 || H5Aread(attribute, type, value.data()) < 0) return false;
  value.resize(std::min(value.find('\0'), value.size()));
  return true;
}

/// Makes the groups that a data set of this name lies in. Like all objects they tell no time of their making: the same
/// state is the same file.
inline void make_groups(hid_t file, const std::string& name) {
  for (auto end = name.find('/'); end != std::string::npos; end = name.find('/', end + 1)) {
    const std::string group = name.substr(0, end), problem = "cannot write '" + group + "'";
    if (group.empty() || H5Lexists(file, group.c_str(), H5P_DEFAULT) > 0) continue;
    Hdf5 creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, problem);
    H5Pset_obj_track_times(creation, false);
    Hdf5 made(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose, problem);
    if (!made.close()) throw Error(problem);
  }
}

/// A data set of a column: in pieces of about a megabyte, their bytes shuffled, compressed and checksummed.
inline void write_column(hid_t file, const std::string& name, const Column& c) {
  const std::string problem = "cannot write '" + name + "'";
  std::size_t length = 0;
  std::string joined;
  const void* data = c.bytes().data();
  if (c.kind == ColumnKind::text) {
    for (const std::string& text : c.texts) length = std::max(length, text.size());
    length = std::max<std::size_t>(length, 1);
    for (const std::string& text : c.texts) joined += text + std::string(length - text.size(), '\0');
    data = joined.data();
  }
  const bool is_text = c.kind == ColumnKind::text;
  const hsize_t size[2] = {c.rows(), c.width};
  const int rank = c.width > 1 ? 2 : 1;
  Hdf5 space(H5Screate_simple(rank, size, nullptr), H5Sclose, problem);
  make_groups(file, name);
  Hdf5 creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, problem);
  H5Pset_obj_track_times(creation, false);
  if (c.rows() > 0) {
    const std::size_t row = is_text ? length : c.row_bytes();
    const hsize_t piece[2] = {std::min<hsize_t>(c.rows(), std::max<std::size_t>(1, (std::size_t{1} << 20) / row)),
                              c.width};
    H5Pset_chunk(creation, rank, piece);
    H5Pset_shuffle(creation);
    if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) H5Pset_deflate(creation, 1);
    H5Pset_fletcher32(creation);
  }
  Hdf5 type(is_text ? text_type(length) : H5Tcopy(type_in_file(c.kind)), H5Tclose, problem);
  Hdf5 set(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose, problem);
  if (c.rows() > 0 &&
      H5Dwrite(set, is_text ? hid_t{type} : type_in_memory(c.kind), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    throw Error(problem);
  }
  if (!c.unit.empty()) write_attribute(set, "unit", c.unit);
  if (!set.close()) throw Error(problem);
}

inline Column read_column(hid_t file, const std::string& name) {
  const std::string problem = "'" + name + "' is damaged (a checksum does not match, or a piece is missing)";
  Hdf5 set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, problem);
  Hdf5 type(H5Dget_type(set), H5Tclose, problem), space(H5Dget_space(set), H5Sclose, problem);
  Column c;
  if (H5Tget_class(type) == H5T_STRING) {
    c.kind = ColumnKind::text;
  } else if (H5Tget_class(type) == H5T_FLOAT) {
    c.kind = ColumnKind::real;
  } else {
    const bool is_signed = H5Tget_sign(type) == H5T_SGN_2;
    const std::size_t bytes = H5Tget_size(type);
    c.kind = is_signed    ? ColumnKind::integer
             : bytes == 8 ? ColumnKind::natural
             : bytes == 4 ? ColumnKind::natural32
                          : ColumnKind::byte;
  }
  const int rank = H5Sget_simple_extent_ndims(space);
  hsize_t size[2] = {0, 1};
  if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space, size, nullptr) < 0) throw Error(problem);
  c.width = size[1];
  if (c.width == 0 || size[0] > (std::uint64_t{1} << 40) / c.width) throw Error(problem);
  if (c.kind == ColumnKind::text) {
    const std::size_t length = H5Tget_size(type);
    std::string joined(size[0] * length, '\0');
    if (H5Tis_variable_str(type) > 0) throw Error(problem);
    if (size[0] > 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, joined.data()) < 0) throw Error(problem);
    for (std::size_t k = 0; k < size[0]; ++k) {
      std::string text = joined.substr(k * length, length);
      c.texts.push_back(text.substr(0, text.find('\0')));
    }
  } else {
    c.own.resize(size[0] * c.row_bytes());
    if (size[0] > 0 && H5Dread(set, type_in_memory(c.kind), H5S_ALL, H5S_ALL, H5P_DEFAULT, c.own.data()) < 0) {
      throw Error(problem);
    }
  }
  read_attribute(set, "unit", c.unit);
  return c;
}

}  // namespace detail

/// Writes columns to a file, complete or not at all: to `<path>.tmp`, synchronised with the disk, then renamed. Throws
/// Error.
inline void write_columns(const std::filesystem::path& path, const StateColumns& columns) {
  if (detail::is_device(path)) fail("cannot save '{}': it is a device; choose a file", path.string());
  const std::filesystem::path file_itself = detail::behind_links(path);
  make_folder_of(file_itself);
  const std::filesystem::path temporary = std::filesystem::path(file_itself) += ".tmp";
  const detail::QuietHdf5 quiet;
  try {
    detail::Hdf5 creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "no memory");
    detail::Hdf5 access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no memory");
    H5Pset_userblock(creation, detail::Seal::size);
    H5Pset_obj_track_times(creation, false);
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);  // whose headers are checksummed too
    detail::Hdf5 file(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose,
                      "cannot open '" + temporary.string() + "'");
    for (const auto& [name, column] : columns) detail::write_column(file, name, column);
    detail::write_attribute(file, "what", "state of a dem world, schema " + std::to_string(checkpoint_schema));
    if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || !file.close()) throw Error("the disk takes no more");
    detail::seal(temporary);
    std::filesystem::rename(temporary, file_itself);
    const auto folder = file_itself.parent_path();
    detail::synchronise(folder.empty() ? std::filesystem::path(".") : folder);
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    fail("cannot save '{}': {}; check that you may write there and that the disk is not full", path.string(),
         error.what());
  }
}

/// Reads them back. Throws Error for a file that is none of these, of another schema, cut short or damaged.
inline StateColumns read_columns(const std::filesystem::path& path) {
  detail::check_seal(path);
  const detail::QuietHdf5 quiet;
  StateColumns columns;
  try {
    detail::Hdf5 file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "HDF5 cannot open it");
    std::vector<std::string> names;
    const auto note = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
      if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(list)->push_back(name);
      return 0;
    };
#if H5_VERSION_GE(1, 12, 0)
    const herr_t visited = H5Ovisit3(file, H5_INDEX_NAME, H5_ITER_NATIVE, note, &names, H5O_INFO_BASIC);
#else
    const herr_t visited = H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, note, &names, H5O_INFO_BASIC);
#endif
    if (visited < 0) throw Error("HDF5 cannot list what is in it");
    for (const std::string& name : names) columns.emplace(name, detail::read_column(file, name));
  } catch (const std::bad_alloc&) {
    fail("cannot load '{}': there is not enough memory for it", path.string());
  } catch (const Error& problem) {
    fail("cannot load '{}': {}", path.string(), problem.what());
  }
  return columns;
}

}  // namespace dem::io
