#pragma once

#include <dem/core/error.hpp>
#include <dem/math/indexed_mesh.hpp>
#include <dem/math/vector.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
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

/// Finds the principal axes. A tensor that is diagonal already (to 1e-12) keeps its axes, so that a part that was drawn
/// along its axes stays as drawn. Throws Error unless the tensor is symmetric (to 1e-9).
inline PrincipalAxes principal_axes(const Mat3& inertia) {
  const double scale = inertia.cwiseAbs().maxCoeff();
  const double skew = (inertia - inertia.transpose()).cwiseAbs().maxCoeff();
  if (!(skew <= 1e-9 * scale)) {  // also if an element is not a number
    fail(
        "an inertia tensor is not symmetric: elements across its diagonal differ by {:g} where the largest is {:g}, "
        "allowed is 1e-9 of it; give both halves of the tensor, with the products of inertia negative",
        skew, scale);
  }
  const Mat3 off = inertia - Mat3(inertia.diagonal().asDiagonal());
  if (off.cwiseAbs().maxCoeff() <= 1e-12 * scale) return {inertia.diagonal(), Mat3::Identity()};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  return {solver.eigenvalues(), axes};
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
/// grid, and each column integrated exactly along its axis. With the default grid the error is about 1e-4 of the
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

}  // namespace dem
