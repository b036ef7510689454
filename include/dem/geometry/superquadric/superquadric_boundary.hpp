#pragma once

#include <dem/geometry/superquadric/superquadric_solid.hpp>

#include <array>
#include <vector>

namespace dem::shape {

/// Points spread over the surface of a superquadric, with the share of the surface that belongs to each, and the quads
/// between them.
struct SuperquadricBoundary {
  std::vector<SurfacePoint> points;
  std::vector<double> areas;                       ///< m^2 for each point; they sum to the surface area
  std::vector<std::array<std::int32_t, 4>> quads;  ///< indices of points, counter-clockwise from outside
};

/// A cube with `divisions` cells along each edge, scaled to the radii and drawn radially onto the surface: its 6 n^2 +
/// 2 nodes lie on the faces, along the edges and on the corners of the grain. A node owns the quarters of the cells
/// around it; a surface element that is drawn out from the element dS of a plane at the distance h is
/// dA = h dS / (gauge^3 x . n), integrated with 3 x 3 Gauss points a quarter. Throws Error unless 1 <= divisions <= 26,
/// which is below 4096 points.
inline SuperquadricBoundary superquadric_boundary(const SuperquadricSolid& solid, int divisions) {
  if (divisions < 1 || divisions > 26) {
    fail("a superquadric was given {} divisions of its edges, but takes 1 to 26 (6 n^2 + 2 points)", divisions);
  }
  const int n = divisions, row = n + 1;
  const double radius[3] = {solid.radius().x, solid.radius().y, solid.radius().z};
  const auto at = [&](const std::array<double, 3>& node) {  // of the cube, 0 to n along each edge
    return Vector3<double>{radius[0] * (2.0 * node[0] / n - 1.0), radius[1] * (2.0 * node[1] / n - 1.0),
                           radius[2] * (2.0 * node[2] / n - 1.0)};
  };

  SuperquadricBoundary boundary;
  std::vector<std::int32_t> number(static_cast<std::size_t>(row * row * row), -1);
  const auto number_of = [&](const std::array<int, 3>& k) -> std::int32_t& {
    return number[static_cast<std::size_t>((k[0] * row + k[1]) * row + k[2])];
  };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k <= n; ++k) {
        if (i % n != 0 && j % n != 0 && k % n != 0) continue;
        number_of({i, j, k}) = static_cast<std::int32_t>(boundary.points.size());
        boundary.points.push_back(solid.radial(at({double(i), double(j), double(k)})));
      }
    }
  }

  boundary.areas.assign(boundary.points.size(), 0.0);
  const double gauss[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)},
               weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (int side = 0; side < 6; ++side) {
    const int up = side / 2, u = (up + 1) % 3, v = (up + 2) % 3, level = side % 2 == 0 ? 0 : n;
    const double plane = radius[up] * 4.0 * radius[u] * radius[v] / (n * n);  // distance times area of a cell
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto node = [&](int du, int dv) {
          std::array<int, 3> k = {};
          k[static_cast<std::size_t>(up)] = level;
          k[static_cast<std::size_t>(u)] = i + du;
          k[static_cast<std::size_t>(v)] = j + dv;
          return number_of(k);
        };
        boundary.quads.push_back(level == n ? std::array{node(0, 0), node(1, 0), node(1, 1), node(0, 1)}
                                            : std::array{node(0, 0), node(0, 1), node(1, 1), node(1, 0)});
        for (int quarter = 0; quarter < 4; ++quarter) {
          const int du = quarter & 1, dv = quarter >> 1;
          double sum = 0.0;
          for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
              std::array<double, 3> place = {};
              place[static_cast<std::size_t>(up)] = level;
              place[static_cast<std::size_t>(u)] = i + 0.5 * (du + gauss[a]);
              place[static_cast<std::size_t>(v)] = j + 0.5 * (dv + gauss[b]);
              const Vector3<double> drawn = at(place);
              const double gauge = solid.gauge(drawn);
              const SurfacePoint out = solid.radial(drawn);
              sum += 0.25 * weight[a] * weight[b] * plane / (gauge * gauge * gauge * dot(out.position, out.normal));
            }
          }
          boundary.areas[static_cast<std::size_t>(node(du, dv))] += sum;
        }
      }
    }
  }
  return boundary;
}

}  // namespace dem::shape
