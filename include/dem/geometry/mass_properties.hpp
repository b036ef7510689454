#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/mesh/indexed_mesh.hpp>
#include <dem/math/rotation.hpp>
#include <dem/math/vector.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <numbers>
#include <span>
#include <vector>

namespace dem {

/// Volume integrals of a solid of density 1.
struct MassProperties {
  double volume = 0.0;          ///< m^3
  Vec3 centre = Vec3::Zero();   ///< m
  Mat3 inertia = Mat3::Zero();  ///< m^5, about the centre; times the density: kg m^2
};

/// Principal axes of an inertia tensor.
struct PrincipalAxes {
  Vec3 moments;   ///< ascending only by accident; order follows the axes
  Mat3 rotation;  ///< columns: the axes; a proper rotation
};

namespace detail {

/// Of all frames along these eigenvectors (ascending eigenvalues) the one that turns the unit axes least. Eigenvectors
/// of equal eigenvalues may be any in their plane.
inline Mat3 nearest_axes(const Vec3& values, const Mat3& vectors) {
  const double equal = 1e-6 * values.cwiseAbs().maxCoeff();
  const bool low = values[1] - values[0] < equal, high = values[2] - values[1] < equal;
  if (low && high) return Mat3::Identity();
  if (low || high) {
    Vec3 z = vectors.col(low ? 2 : 0);  // of the moment that differs
    int k;
    z.cwiseAbs().maxCoeff(&k);
    if (z[k] < 0.0) z = -z;
    return rotation_between(Vec3::Unit(k), z);
  }
  std::array<int, 3> order = {0, 1, 2};
  Mat3 best = Mat3::Identity();
  double least_turned = -4.0;  // the trace is 1 + 2 cos(angle)
  do {
    for (int signs = 0; signs < 4; ++signs) {  // the third sign makes it a rotation
      Mat3 m;
      m.col(0) = (signs & 1 ? -1.0 : 1.0) * vectors.col(order[0]);
      m.col(1) = (signs & 2 ? -1.0 : 1.0) * vectors.col(order[1]);
      m.col(2) = m.col(0).cross(m.col(1));
      if (m.trace() > least_turned) {
        least_turned = m.trace();
        best = m;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

}  // namespace detail

/// Finds the principal axes, in the order and with the signs that turn the given axes least. A tensor that is diagonal
/// already (to 1e-12) keeps its axes. Moments that differ by less than 1e-6 of the largest count as equal, as those of
/// a wheel of single precision do, and their axes stay as near to the given ones as they can: a part that was drawn
/// along its axes stays as drawn. Throws Error unless the tensor is finite and symmetric (to 1e-9).
inline PrincipalAxes principal_axes(const Mat3& inertia) {
  if (!inertia.allFinite()) {  // looked at first, as the largest of several numbers may leave a NaN out
    fail("an inertia tensor has moments {:g}, {:g}, {:g} and products {:g}, {:g}, {:g}, but all must be finite",
         inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2));
  }
  const double scale = inertia.cwiseAbs().maxCoeff();
  const double skew = (inertia - inertia.transpose()).cwiseAbs().maxCoeff();
  if (!(skew <= 1e-9 * scale)) {
    fail(
        "an inertia tensor is not symmetric: elements across its diagonal differ by {:g} where the largest is {:g}, "
        "allowed is 1e-9 of it; give both halves of the tensor, with the products of inertia negative",
        skew, scale);
  }
  const Mat3 off = inertia - Mat3(inertia.diagonal().asDiagonal());
  if (off.cwiseAbs().maxCoeff() <= 1e-12 * scale) return {inertia.diagonal(), Mat3::Identity()};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  const Mat3 axes = detail::nearest_axes(solver.eigenvalues(), solver.eigenvectors());
  return {(axes.transpose() * inertia * axes).diagonal(), axes};
}

inline MassProperties sphere_mass_properties(double radius) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  return {volume, Vec3::Zero(), 0.4 * volume * radius * radius * Mat3::Identity()};
}

/// A box with the given edge lengths.
inline MassProperties box_mass_properties(const Vec3& edges) {
  const double volume = edges.prod();
  const Vec3 squares = edges.cwiseProduct(edges);
  const Vec3 moments = volume / 12.0 * (Vec3::Constant(squares.sum()) - squares);
  return {volume, Vec3::Zero(), moments.asDiagonal()};
}

/// A closed triangle mesh, by summing the signed tetrahedra that the triangles span with the first vertex. Throws Error
/// if a corner index is out of range or the volume is not positive.
inline MassProperties mesh_mass_properties(std::span<const Vec3> vertices,
                                           std::span<const std::array<std::uint32_t, 3>> triangles) {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();   // integral of x
  Mat3 second = Mat3::Zero();  // integral of x x^T
  for (const auto& t : triangles) {
    for (const auto corner : t) {
      if (corner >= vertices.size()) {
        fail("a triangle of a mesh names corner {}, but there are {} vertices", corner, vertices.size());
      }
    }
    // Relative to the first vertex, so that a mesh far from the origin loses no digits.
    const Vec3 a = vertices[t[0]] - vertices[0], b = vertices[t[1]] - vertices[0], c = vertices[t[2]] - vertices[0];
    const double v = a.dot(b.cross(c)) / 6.0;
    const Vec3 sum = a + b + c;
    volume += v;
    first += v / 4.0 * sum;
    second += v / 20.0 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (!(volume > 0.0)) {
    fail(
        "a mesh encloses {:g} m^3, but a body needs a positive volume: close the mesh and order the corners of each "
        "triangle counter-clockwise seen from outside",
        volume);
  }
  const Vec3 c = first / volume;
  const Mat3 covariance = second - volume * c * c.transpose();
  return {volume, c + vertices[0], covariance.trace() * Mat3::Identity() - covariance};
}
inline MassProperties mesh_mass_properties(const IndexedMesh& mesh) {
  return mesh_mass_properties(mesh.vertices, mesh.triangles);
}

struct Ball {
  Vec3 centre;    ///< m
  double radius;  ///< m
};

/// Volume integrals of a union of balls, overlapping parts counted once: the union is cut into columns of a square
/// grid, and each column integrated exactly along its axis. With the default grid the error is up to 2e-4 of the
/// volume.
inline MassProperties union_mass_properties(std::span<const Ball> balls, int columns_per_edge = 400) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Ball& b : balls) {
    low = low.cwiseMin(b.centre - Vec3::Constant(b.radius));
    high = high.cwiseMax(b.centre + Vec3::Constant(b.radius));
  }
  const double dx = (high.x() - low.x()) / columns_per_edge, dy = (high.y() - low.y()) / columns_per_edge;
  double m = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  std::vector<std::pair<double, double>> spans;
  for (int i = 0; i < columns_per_edge; ++i) {
    for (int j = 0; j < columns_per_edge; ++j) {
      const double x = low.x() + (i + 0.5) * dx, y = low.y() + (j + 0.5) * dy;
      spans.clear();
      for (const Ball& b : balls) {
        const double u = x - b.centre.x(), v = y - b.centre.y();
        const double h2 = b.radius * b.radius - u * u - v * v;
        if (h2 > 0.0) spans.emplace_back(b.centre.z() - std::sqrt(h2), b.centre.z() + std::sqrt(h2));
      }
      std::sort(spans.begin(), spans.end());
      for (std::size_t k = 0; k < spans.size();) {
        double from = spans[k].first, to = spans[k].second;
        while (++k < spans.size() && spans[k].first <= to) to = std::max(to, spans[k].second);
        const double l = to - from, l2 = (to * to - from * from) / 2, l3 = (to * to * to - from * from * from) / 3;
        m += l;
        first += Vec3(x * l, y * l, l2);
        second += (Mat3() << x * x * l, x * y * l, x * l2, x * y * l, y * y * l, y * l2, x * l2, y * l2, l3).finished();
      }
    }
  }
  const double cell = dx * dy;
  MassProperties p;
  p.volume = m * cell;
  p.centre = first / m;
  const Mat3 about_centre = second * cell - p.volume * p.centre * p.centre.transpose();
  p.inertia = about_centre.trace() * Mat3::Identity() - about_centre;
  return p;
}

/// Whether two balls share more than a touch: overlaps of less than a millionth of the smaller radius, whose volume is
/// lost in rounding, are a touch.
inline bool any_overlap(std::span<const Ball> balls) {
  for (std::size_t k = 0; k < balls.size(); ++k) {
    for (std::size_t m = 0; m < k; ++m) {
      const double r = balls[k].radius, s = balls[m].radius;
      if ((balls[k].centre - balls[m].centre).norm() < r + s - 1e-6 * std::min(r, s)) return true;
    }
  }
  return false;
}

/// Volume integrals of balls that do not overlap, by Steiner's theorem: exact.
inline MassProperties separate_mass_properties(std::span<const Ball> balls) {
  MassProperties p;
  for (const Ball& b : balls) {
    const double volume = sphere_mass_properties(b.radius).volume;
    p.volume += volume;
    p.centre += volume * b.centre;
  }
  p.centre /= p.volume;
  for (const Ball& b : balls) {
    const MassProperties ball = sphere_mass_properties(b.radius);
    const Vec3 arm = b.centre - p.centre;
    p.inertia += ball.inertia + ball.volume * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return p;
}

}  // namespace dem
