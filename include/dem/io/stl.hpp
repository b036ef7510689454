#pragma once
// Triangle meshes in STL files, ascii and binary (the format of stereolithography, 3D Systems 1989).

#include <dem/geometry/mesh/indexed_mesh.hpp>
#include <dem/io/file.hpp>
#include <dem/io/mesh_text.hpp>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::io {

/// A part of an STL file.
struct StlSolid {
  std::string name;  ///< as in the file; often empty, and always of a binary file
  IndexedMesh mesh;
};

namespace detail {

inline constexpr std::size_t stl_header = 84, stl_record = 50;  // bytes

/// Little-endian, as the format has it, whatever this machine has.
inline std::uint32_t stl_word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + k])} << (8 * k);
  return value;
}

inline IndexedMesh read_binary_stl(std::string_view bytes, const std::string& file) {
  const std::uint32_t count = stl_word(bytes, 80);
  const std::size_t there = (bytes.size() - stl_header) / stl_record;
  if (there < count) {
    fail(
        "'{}': the header, at byte 80, announces {} triangles of 50 bytes, but the file ends at byte {}, after {} of "
        "them; it was cut off: copy or export it again",
        file, count, bytes.size(), there);
  }
  if (count == 0) fail("'{}': the header, at byte 80, announces no triangles; export the mesh again", file);
  IndexedMesh mesh;
  mesh.vertices.reserve(std::size_t{3} * count);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = stl_header + t * stl_record + 12 * (k + 1);  // after the normal, which is not used
      Vec3 v;
      for (std::size_t c = 0; c < 3; ++c) {
        v[static_cast<Eigen::Index>(c)] = static_cast<double>(std::bit_cast<float>(stl_word(bytes, at + 4 * c)));
      }
      if (!v.allFinite()) {
        fail("'{}', byte {}: corner {} of triangle {} is not a finite number; correct the mesh and export it again",
             file, at, k, t);
      }
      mesh.vertices.push_back(v);
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

inline std::vector<StlSolid> read_ascii_stl(std::string_view text, const std::string& file) {
  Words words(text, file);
  std::vector<StlSolid> solids;
  const auto expect = [&](std::string_view wanted) {
    const std::string_view word = words.next();
    if (lower(word) == wanted) return;
    if (word.empty()) {
      fail("'{}', line {}: the file ends where '{}' should stand; it was cut off: copy or export it again", file,
           words.line(), wanted);
    }
    fail("'{}', line {}: found '{}' where '{}' should stand; correct it", file, words.line(), shown(word), wanted);
  };
  while (!words.at_end()) {
    expect("solid");
    const std::string name = words.rest_of_line();
    IndexedMesh mesh;
    while (lower(words.peek()) == "facet") {
      expect("facet");
      expect("normal");
      for (int k = 0; k < 3; ++k) words.next();  // often wrong, and not needed
      expect("outer");
      expect("loop");
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int k = 0; k < 3; ++k) {
        expect("vertex");
        Vec3 v;
        for (Eigen::Index c = 0; c < 3; ++c) v[c] = words.number(words.next(), "a coordinate");
        mesh.vertices.push_back(v);
      }
      expect("endloop");
      expect("endfacet");
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    expect("endsolid");
    words.skip_line();
    if (!mesh.triangles.empty()) solids.push_back({name, std::move(mesh)});
  }
  if (solids.empty()) fail("'{}' holds no facets; export the mesh again", file);
  return solids;
}

}  // namespace detail

/// The solids in the bytes of an STL file, at least one; `file` is its name for messages. A binary file is one solid.
/// Each triangle has vertices of its own: `repaired` (geometry/mesh/mesh_repair.hpp), which surface::TriangleMesh and
/// mesh_body call, merges them. Lengths are as in the file, often mm: use IndexedMesh::scaled. Throws Error, with line
/// or byte, for everything that is not an STL file.
[[nodiscard]] inline std::vector<StlSolid> parse_stl_solids(std::string_view bytes, const std::string& file) {
  // A binary header may begin with "solid", too: a file of just the length that byte 80 announces is binary.
  const bool has_header = bytes.size() >= detail::stl_header;
  const bool length_fits =
      has_header && bytes.size() == detail::stl_header + detail::stl_record * std::size_t{detail::stl_word(bytes, 80)};
  const std::string_view text = bytes.substr(bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);  // after a byte order mark
  const bool says_solid = detail::lower(detail::Words(text.substr(0, 4096), file).next()) == "solid";
  const bool has_zeros = bytes.find('\0') != std::string_view::npos;
  if (says_solid && !length_fits && !has_zeros) return detail::read_ascii_stl(text, file);
  if (!has_header) {
    fail(
        "'{}' has {} bytes and does not begin with 'solid': it is neither an ascii nor a binary STL file (84 bytes and "
        "more); export the mesh again",
        file, bytes.size());
  }
  return {{"", detail::read_binary_stl(bytes, file)}};
}
/// Reads the solids of an STL file, as the blades of a mixer that move apart. Throws Error as parse_stl_solids does, or
/// if the file cannot be read.
[[nodiscard]] inline std::vector<StlSolid> read_stl_solids(const std::filesystem::path& path) {
  return parse_stl_solids(read_file(path), path.string());
}

/// All solids as one mesh. Otherwise as parse_stl_solids.
[[nodiscard]] inline IndexedMesh parse_stl(std::string_view bytes, const std::string& file) {
  IndexedMesh all;
  for (const StlSolid& solid : parse_stl_solids(bytes, file)) all += solid.mesh;
  return all;
}
/// Reads an STL file. Throws Error as parse_stl does, or if the file cannot be read.
[[nodiscard]] inline IndexedMesh read_stl(const std::filesystem::path& path) {
  return parse_stl(read_file(path), path.string());
}

/// Writes a mesh as a binary STL file: coordinates rounded to 24 bits, as the format has it. Throws Error if an index
/// or a coordinate is out of range or the file cannot be written.
inline void write_stl(const std::filesystem::path& path, const IndexedMesh& mesh) {
  check_indices(mesh);
  if (mesh.triangles.size() > 0xffffffffu) fail("an STL file takes at most 4,294,967,295 triangles");
  std::string bytes(80, ' ');
  bytes.replace(0, 3, "dem");
  const auto word = [&](std::uint32_t value) {
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xffu);
  };
  const auto vector = [&](const Vec3& v) {
    if (!(v.cwiseAbs().maxCoeff() <= double{std::numeric_limits<float>::max()})) {
      fail("a coordinate of {:g} does not fit into an STL file, whose numbers end at 3.4e38; scale the mesh",
           v.cwiseAbs().maxCoeff());
    }
    for (Eigen::Index c = 0; c < 3; ++c) word(std::bit_cast<std::uint32_t>(static_cast<float>(v[c])));
  };
  word(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 normal = mesh.area_vector(t);
    vector(normal.norm() > 0.0 ? Vec3(normal.normalized()) : normal);
    for (int k = 0; k < 3; ++k) vector(mesh.corner(t, k));
    bytes += std::string(2, '\0');
  }
  write_file(path, bytes);
}

}  // namespace dem::io
