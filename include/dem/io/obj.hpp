#pragma once
// Triangle meshes in OBJ files (Wavefront): vertices and faces; everything else in such a file is skipped.

#include <dem/geometry/mesh/indexed_mesh.hpp>
#include <dem/io/file.hpp>
#include <dem/io/mesh_text.hpp>

namespace dem::io {

namespace detail {

/// Whether all triangles of a fan from a polygon's first corner look the way that the polygon does (the sum of their
/// areas as vectors), but for slivers of rounding.
inline bool is_convex(const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& corners) {
  const auto area = [&](std::size_t k) -> Vec3 {
    const Vec3& from = vertices[corners[0]];
    return (vertices[corners[k - 1]] - from).cross(vertices[corners[k]] - from);
  };
  Vec3 whole = Vec3::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k) whole += area(k);
  for (std::size_t k = 2; k < corners.size(); ++k) {
    if (area(k).dot(whole) < -1e-6 * whole.squaredNorm()) return false;
  }
  return true;
}

}  // namespace detail

/// The mesh in the text of an OBJ file; `file` is its name for messages. Reads `v x y z` and `f a b c ...`, where a
/// face names vertices from 1 on, or backwards from -1, perhaps with /texture/normal, which is skipped; a face of more
/// than three corners is cut into a fan. Lines may go on after a backslash. Throws Error with the line for a vertex
/// that is not three numbers, a face that names a vertex that is not there or is not convex, and a file without faces.
[[nodiscard]] inline IndexedMesh parse_obj(std::string_view given, const std::string& file) {
  std::string text(given);
  for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
    std::size_t end = at + 1;
    if (end < text.size() && text[end] == '\r') ++end;
    if (end < text.size() && text[end] == '\n') ++end;
    for (std::size_t k = at; end > at + 1 && k < end; ++k) text[k] = ' ';
    if (end > at + 1) text[end - 1] = detail::Words::joined_line;
  }
  detail::Words words(text, file);
  IndexedMesh mesh;
  while (!words.at_end()) {
    const std::string_view keyword = words.next();
    if (keyword == "v") {
      Vec3 v;
      for (Eigen::Index c = 0; c < 3; ++c) v[c] = words.number(words.next_in_line(), "a coordinate");
      mesh.vertices.push_back(v);
    } else if (keyword == "f") {
      std::vector<std::uint32_t> corners;
      for (std::string_view word = words.next_in_line(); !word.empty() && word[0] != '#'; word = words.next_in_line()) {
        const std::string_view digits = word.substr(0, word.find('/'));
        long long index = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        const auto count = static_cast<long long>(mesh.vertices.size());
        const bool is_number = error == std::errc() && end == digits.data() + digits.size() && !digits.empty();
        const long long place = index < 0 ? count + index : index - 1;
        if (!is_number || index == 0 || place < 0 || place >= count) {
          fail(
              "'{}', line {}: a face names the vertex '{}', but must name one of the {} before it: 1 to {}, or -1 "
              "(the last) to -{}; correct the index",
              file, words.line(), detail::shown(word), count, count, count);
        }
        corners.push_back(static_cast<std::uint32_t>(place));
      }
      if (corners.size() < 3) {
        fail("'{}', line {}: a face has {} corners, but needs at least 3; correct or remove it", file, words.line(),
             corners.size());
      }
      if (!detail::is_convex(mesh.vertices, corners)) {
        fail(
            "'{}', line {}: a face of {} corners is not convex, so it cannot be cut into triangles from its first "
            "corner; export the mesh as triangles",
            file, words.line(), corners.size());
      }
      for (std::size_t k = 2; k < corners.size(); ++k) {
        mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
      }
    }
    words.skip_line();
  }
  if (mesh.triangles.empty()) {
    fail("'{}' holds {} vertices and no faces ('f' lines); export it as a mesh, not as curves or points", file,
         mesh.vertices.size());
  }
  return mesh;
}
/// Reads an OBJ file. Throws Error as parse_obj does, or if the file cannot be read.
[[nodiscard]] inline IndexedMesh read_obj(const std::filesystem::path& path) {
  return parse_obj(read_file(path), path.string());
}

}  // namespace dem::io
