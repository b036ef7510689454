#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/indexed_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

// Closed meshes made by code. All are centred at the origin; cylinders, wheels and tyres have their axis along z.

namespace dem::mesh {

/// A box with the given edge lengths (m), each > 0: 12 triangles, or more if each edge is cut into `pieces`.
IndexedMesh box(const Vec3& edges, int pieces = 1);

/// A flat rectangle in z = 0, facing +z, cut into nx times ny cells of two triangles. Not closed.
IndexedMesh rectangle(double size_x, double size_y, int nx = 1, int ny = 1);

/// The solid that a profile sweeps when it turns about z: profile points (radius, z) in m, from low z to high z as seen
/// outside; the first and the last point lie on the axis if their radius is 0, else the profile is closed to itself
/// (a ring). Throws Error for less than 3 segments or less than 3 points.
IndexedMesh revolved(const std::vector<std::array<double, 2>>& profile, int segments);

/// A full cylinder (m): a prism whose corners lie on the radius.
IndexedMesh cylinder(double radius, double length, int segments = 48);

/// A sphere (m): an icosahedron whose triangles are cut in four `refinements` times: 20 * 4^refinements triangles.
IndexedMesh sphere(double radius, int refinements = 3);

/// A wheel with straight grousers (m).
struct Wheel {
  double radius;  ///< of the rim
  double width;   ///< along the axis
  int grousers = 0;
  double grouser_height = 0.0;     ///< beyond the rim
  double grouser_thickness = 0.0;  ///< along the circumference
  int segments = 72;               ///< of the rim, at least; each gap between grousers gets the same number
};

/// One closed solid: the rim is a prism, each grouser a bar that stands on it. Throws Error if grousers overlap.
IndexedMesh wheel(const Wheel& w);

/// A tyre without a rim (a ring): outer diameter and width in m, with a rounded profile. It has about as many triangles
/// as asked for, a grid of nearly square cells (6,650 for 6,662). The hole has `hole` times the diameter.
IndexedMesh tyre(double diameter, double width, int triangles = 6662, double hole = 0.5);

}  // namespace dem::mesh

#if DEM_DEFINES

namespace dem::mesh {

DEM_INLINE IndexedMesh box(const Vec3& edges, int pieces) {
  for (int k = 0; k < 3; ++k) require_positive(edges[k], "edge length of a box mesh", "m");
  if (pieces < 1) fail("a box mesh was asked for {} pieces an edge, but needs at least 1", pieces);
  IndexedMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [place, fresh] = known.try_emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) {
      Vec3 v;
      for (int k = 0; k < 3; ++k) v[k] = edges[k] * (double(at[static_cast<std::size_t>(k)]) / pieces - 0.5);
      mesh.vertices.push_back(v);
    }
    return place->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, pieces}) {
      for (int i = 0; i < pieces; ++i) {
        for (int j = 0; j < pieces; ++j) {
          std::array<int, 3> at[4];
          for (int k = 0; k < 4; ++k) {  // round the small square, counter-clockwise about +axis
            at[k][axis] = side;
            at[k][(axis + 1) % 3] = i + (k == 1 || k == 2);
            at[k][(axis + 2) % 3] = j + (k >= 2);
          }
          if (side == 0) std::swap(at[1], at[3]);
          mesh.add_quad(vertex(at[0]), vertex(at[1]), vertex(at[2]), vertex(at[3]));
        }
      }
    }
  }
  return mesh;
}

DEM_INLINE IndexedMesh rectangle(double size_x, double size_y, int nx, int ny) {
  require_positive(size_x, "edge length of a rectangle mesh", "m");
  require_positive(size_y, "edge length of a rectangle mesh", "m");
  if (nx < 1 || ny < 1) fail("a rectangle mesh was asked for {} times {} cells, but needs at least 1 of each", nx, ny);
  IndexedMesh mesh;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      mesh.vertices.emplace_back(size_x * (double(i) / nx - 0.5), size_y * (double(j) / ny - 0.5), 0.0);
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (nx + 1) + i); };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) mesh.add_quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return mesh;
}

DEM_INLINE IndexedMesh revolved(const std::vector<std::array<double, 2>>& profile, int segments) {
  if (segments < 3 || profile.size() < 3) {
    fail("a revolved mesh was asked for {} segments and {} profile points, but needs at least 3 of each", segments,
         profile.size());
  }
  const bool ring = profile.front()[0] > 0.0;
  IndexedMesh mesh;
  std::vector<std::uint32_t> first;  // vertex of each profile point in segment 0
  for (const auto& [r, z] : profile) {
    require_non_negative(r, "radius of a profile point", "m");
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    if (r == 0.0) {
      mesh.vertices.emplace_back(0, 0, z);
      continue;
    }
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / segments;
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const auto at = [&](std::size_t k, int s) {
    return profile[k][0] == 0.0 ? first[k] : first[k] + static_cast<std::uint32_t>(s % segments);
  };
  const std::size_t bands = ring ? profile.size() : profile.size() - 1;
  for (std::size_t k = 0; k < bands; ++k) {
    const std::size_t next = (k + 1) % profile.size();
    for (int s = 0; s < segments; ++s) {
      const std::uint32_t a = at(k, s), b = at(k, s + 1), c = at(next, s + 1), d = at(next, s);
      if (a == b) {
        mesh.triangles.push_back({a, c, d});
      } else if (c == d) {
        mesh.triangles.push_back({a, b, c});
      } else {
        mesh.add_quad(a, b, c, d);
      }
    }
  }
  return mesh;
}

DEM_INLINE IndexedMesh cylinder(double radius, double length, int segments) {
  require_positive(radius, "radius of a cylinder mesh", "m");
  const double h = 0.5 * require_positive(length, "length of a cylinder mesh", "m");
  return revolved({{0.0, -h}, {radius, -h}, {radius, h}, {0.0, h}}, segments);
}

DEM_INLINE IndexedMesh sphere(double radius, int refinements) {
  require_positive(radius, "radius of a sphere mesh", "m");
  if (refinements < 0 || refinements > 9) fail("a sphere mesh takes 0 to 9 refinements, but was given {}", refinements);
  const double t = std::numbers::phi;
  IndexedMesh mesh{{{-1, t, 0},
                    {1, t, 0},
                    {-1, -t, 0},
                    {1, -t, 0},
                    {0, -1, t},
                    {0, 1, t},
                    {0, -1, -t},
                    {0, 1, -t},
                    {t, 0, -1},
                    {t, 0, 1},
                    {-t, 0, -1},
                    {-t, 0, 1}},
                   {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int level = 0; level < refinements; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, fresh] =
          middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back((mesh.vertices[a].normalized() + mesh.vertices[b].normalized()));
      return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& v : mesh.vertices) v = radius * v.normalized();
  return mesh;
}

DEM_INLINE IndexedMesh wheel(const Wheel& w) {
  require_positive(w.radius, "radius of a wheel mesh", "m");
  require_positive(w.width, "width of a wheel mesh", "m");
  if (w.grousers < 0) fail("a wheel mesh was given {} grousers", w.grousers);
  if (w.grousers == 0) return cylinder(w.radius, w.width, std::max(w.segments, 3));
  require_positive(w.grouser_height, "grouser height of a wheel mesh", "m");
  require_positive(w.grouser_thickness, "grouser thickness of a wheel mesh", "m");
  const double pitch = 2.0 * std::numbers::pi / w.grousers;
  const double foot = 2.0 * std::asin(std::min(1.0, 0.5 * w.grouser_thickness / w.radius));  // angle under a grouser
  if (!(foot < pitch)) {
    fail("{} grousers of {:g} m do not fit round a wheel of radius {:g} m; take fewer or thinner ones", w.grousers,
         w.grouser_thickness, w.radius);
  }
  // The outline, counter-clockwise: up a grouser, across, down, and along the rim to the next.
  std::vector<Vec3> outline;
  std::vector<bool> on_rim;
  const int steps = std::max(1, static_cast<int>(std::lround(w.segments * (pitch - foot) / (2.0 * std::numbers::pi))));
  for (int k = 0; k < w.grousers; ++k) {
    const auto rim = [&](double angle) { return Vec3(w.radius * std::cos(angle), w.radius * std::sin(angle), 0); };
    const double middle = pitch * k;
    const Vec3 up = w.grouser_height * Vec3(std::cos(middle), std::sin(middle), 0);
    const Vec3 from = rim(middle - 0.5 * foot), to = rim(middle + 0.5 * foot);
    for (const Vec3& p : {from, Vec3(from + up), Vec3(to + up)}) outline.push_back(p);
    on_rim.insert(on_rim.end(), {true, false, false});
    for (int s = 0; s < steps; ++s) {
      outline.push_back(rim(middle + 0.5 * foot + (pitch - foot) * s / steps));
      on_rim.push_back(true);
    }
  }
  IndexedMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {-0.5 * w.width, 0.5 * w.width}) {
    for (const Vec3& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  }
  mesh.vertices.emplace_back(0, 0, -0.5 * w.width);
  mesh.vertices.emplace_back(0, 0, 0.5 * w.width);
  const auto cap = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {  // on both sides
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a == 2 * n ? 2 * n + 1 : a + n, b + n, c + n});
  };
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.add_quad(k, next, next + n, k + n);
    if (on_rim[k] && on_rim[next]) cap(2 * n, k, next);
    if (on_rim[k] && !on_rim[next]) {  // a grouser's foot: the hub's triangle below it, and its own face
      const std::uint32_t over = (k + 2) % n, down = (k + 3) % n;
      cap(2 * n, k, down);
      cap(k, next, over);
      cap(k, over, down);
    }
  }
  return mesh;
}

DEM_INLINE IndexedMesh tyre(double diameter, double width, int triangles, double hole) {
  const double outer = 0.5 * require_positive(diameter, "diameter of a tyre mesh", "m");
  require_positive(width, "width of a tyre mesh", "m");
  require_within(hole, 0.05, 0.95, "hole of a tyre mesh as a share of its diameter");
  if (triangles < 60) fail("a tyre mesh was asked for {} triangles, but needs at least 60", triangles);
  // Cells that are about square: circumference over height is round / across.
  const double inner = hole * outer, height = 0.5 * (outer - inner), middle = 0.5 * (outer + inner);
  const double girth = 2.0 * (width + 2.0 * height) * 0.85, round = 2.0 * std::numbers::pi * middle;
  const int across = std::max(5, static_cast<int>(std::lround(std::sqrt(0.5 * triangles * girth / round))));
  const int segments = std::max(6, static_cast<int>(std::lround(0.5 * triangles / across)));
  std::vector<std::array<double, 2>> profile;  // a superellipse of exponent 4: flat tread and walls, round shoulders
  for (int k = 0; k < across; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / across;
    const auto root = [](double v) { return std::copysign(std::sqrt(std::abs(v)), v); };
    profile.push_back({middle + height * root(std::cos(angle)), 0.5 * width * root(std::sin(angle))});
  }
  return revolved(profile, segments);
}

}  // namespace dem::mesh

#endif
