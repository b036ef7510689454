#pragma once

#include <dem/geometry/edge_set.hpp>
#include <dem/geometry/pair_contact.hpp>
#include <dem/geometry/polyhedron/polyhedron.hpp>
#include <dem/geometry/shared_points.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/geometry/superquadric/superquadric_points.hpp>

#include <concepts>

namespace dem::shape {

/// A superquadric of either kind and a polyhedron. They touch by
/// - sample points of the superquadric in the polyhedron (feature: the number of the point);
/// - the support point of the superquadric, which meets the nearest face first (feature: 2^12);
/// - corners of the polyhedron in the superquadric (features from 2^13 on);
/// - three points of each edge: where it is nearest to the superquadric's centre, and half a bounding radius on either
/// side (features from 2^14 on, three per edge).
/// They share one contact, or weigh as the superquadric's points do. What meets between these points is felt late.
template <std::derived_from<SuperquadricGrain> Rounded>
struct PairContact<Rounded, Polyhedron> {
  template <class Callback>
  static void collide(const Rounded& a, const double* pose_a, const Polyhedron& b, const double* pose_b,
                      const Vector3<double>& separation, Callback&& callback) {
    const auto find = [&](auto&& found) { find_points(a, pose_a, b, pose_b, separation, found); };
    if (a.has_shares()) {
      share_points(find, callback);
    } else {
      find(callback);
    }
  }

 private:
  static constexpr std::uint32_t support_feature = 1u << 12, corners = 1u << 13, edges = 1u << 14;

  template <class Callback>
  static void find_points(const Rounded& a, const double* pose_a, const Polyhedron& b, const double* pose_b,
                          const Vector3<double>& separation, Callback&& callback) {
    const Matrix3<double> ra = Rounded::rotation(pose_a), rb = Polyhedron::rotation(pose_b);
    const double radius = a.mean_radius() * b.radius() / (a.mean_radius() + b.radius());
    double depth, weights = 0.0;
    Vector3<double> out;
    // The point that meets the nearest face first, which lies between those of the boundary.
    Vector3<double> support{}, way{};
    double support_depth = 0.0;
    Vector3<double> support_out{};
    bool supported = false;
    NearestPoint nearest_on_b;
    if (a.has_shares() &&
        nearest_point(b.tables(), -transpose_times(rb, separation), a.bounding_radius(), nearest_on_b)) {
      way = -(rb * nearest_on_b.outward);
      support = a.even_support(pose_a, way);
      supported = b.penetration(pose_b, support - separation, support_depth, support_out);
    }
    for (int k = 0; k < a.points().count; ++k) {
      const double own = a.points().weight[static_cast<std::size_t>(k)];
      weights += own;
      const Vector3<double> point = ra * a.points()[k];
      if (!b.penetration(pose_b, point - separation, depth, out)) continue;
      const double weight = supported ? a.beside_support(point, support, way) : 1.0;
      callback(static_cast<std::uint32_t>(k),
               contact::ContactPoint<double>{-out, depth, point + (0.5 * depth) * out, radius, weight * own});
    }
    if (supported) {
      callback(support_feature,
               contact::ContactPoint<double>{-support_out, support_depth, support + (0.5 * support_depth) * support_out,
                                             radius, 1.0});
    }
    const double mean_weight = weights / a.points().count;
    const auto try_point = [&](std::uint32_t feature, const Vector3<double>& in_b, double weight) {
      const Vector3<double> point = separation + rb * in_b;
      if (!a.penetration(pose_a, point, depth, out)) return;
      callback(feature,
               contact::ContactPoint<double>{out, depth, point + (0.5 * depth) * out, radius, weight * mean_weight});
    };
    const PolyhedronTables& t = b.tables();
    for (int k = 0; k < t.corners; ++k) try_point(corners + static_cast<std::uint32_t>(k), t.corner(k), 1.0);
    const Vector3<double> centre = -transpose_times(rb, separation);  // of a, seen from b
    for (int e = 0; e < t.edges; ++e) {
      const PolyhedronTables::Edge& edge = t.edge[static_cast<std::size_t>(e)];
      const Vector3<double> tail = t.corner(edge.tail), along = t.corner(edge.head) - tail;
      const double length = norm(along), nearest = dot(centre - tail, along) / (length * length);
      for (int place = 0; place < 3; ++place) {
        const double share = nearest + (0.5 * place - 0.5) * a.bounding_radius() / length;
        const double to_end = length * min(share, 1.0 - share);  // m
        if (to_end <= 0.0) continue;
        try_point(edges + static_cast<std::uint32_t>(3 * e + place), tail + share * along,
                  surface::weight_on_edge(to_end, a.bounding_radius()));
      }
    }
  }
};

}  // namespace dem::shape
