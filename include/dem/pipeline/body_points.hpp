#pragma once

#include <dem/state/body.hpp>
#include <dem/state/machine_surface.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dem::pipeline {

/// A surface whose points cover it: two such surfaces (or one and a plane) find each other by their points.
template <class S>
concept HasPoints = requires(const S& s, const surface::Bounds& box) {
  s.points(box, [](std::uint32_t, const Vector3<double>&, double) {});
  { s.has_points() } -> std::same_as<bool>;
};
/// A surface with straight sharp edges: edges(box, sink) calls sink(number, one end, other end) for those that may lie
/// in a box of its frame. Numbers are other than those of its points.
template <class S>
concept HasEdges = requires(const S& s, const surface::Bounds& box) {
  s.edges(box, [](std::uint32_t, const Vector3<double>&, const Vector3<double>&) {});
};
/// A solid that tells which part of a line from `tail` to `head` lies in it: clip(tail, head, from, to) cuts the range
/// [from, to] of shares of the way down, and is false if nothing is left.
template <class S>
concept ClipsLines = requires(const S& s, const Vector3<double>& p, double& share) {
  { s.clip(p, p, share, share) } -> std::same_as<bool>;
};
/// A surface with round edges: rims(way, sink) calls sink(number, point) with the point of each that lies farthest
/// along a direction.
template <class S>
concept HasRims = requires(const S& s, const Vector3<double>& way) {
  s.rims(way, [](std::uint32_t, const Vector3<double>&) {});
  { s.bounding_radius() } -> std::same_as<double>;
};
/// A surface that may be one ball: its probe finds every contact, so the partner's points are not needed.
template <class S>
concept MayBeBall = requires(const S& s) {
  { s.is_ball() } -> std::same_as<bool>;
};

template <class Surface>
bool is_ball(const Surface& s) {
  return std::visit(
      []<class G>(const G& geometry) {
        if constexpr (MayBeBall<G>) return geometry.is_ball();
        return false;
      },
      s.geometry);
}
/// Whether a surface shows points to others.
template <class Surface>
bool has_points(const Surface& s) {
  return std::visit(
      []<class G>(const G& geometry) {
        if constexpr (HasPoints<G>) return geometry.has_points();
        return false;
      },
      s.geometry);
}
/// The scale on which a surface is round, for laws that ask for a radius (m): half its smaller extent.
template <class Surface>
double point_radius(const Surface& s) {
  const surface::Bounds b = std::visit([](const auto& geometry) { return geometry.bounds(); }, s.geometry);
  const Vec3 extent = b.high - b.low;
  double smallest = extent.maxCoeff();
  for (int k = 0; k < 3; ++k) {
    if (extent[k] > 1e-6 * extent.maxCoeff()) smallest = std::min(smallest, extent[k]);
  }
  return 0.5 * smallest;
}

/// A point of one surface that may touch another.
struct BodyPoint {
  std::uint32_t number;
  Vector3<double> place;  ///< m, in the frame of its own surface
  double radius;          ///< m, of a ball; 0 for a point
  double weight;
};

/// The box (in the frame of `from`) that both surfaces' bounding boxes share.
template <class Surface>
surface::Bounds shared_box(const Surface& from, const Surface& onto) {
  const Vec3 low = from.low.cwiseMax(onto.low), high = from.high.cwiseMin(onto.high);
  const Mat3 axes = to_eigen(from.axes);
  const Vec3 centre = axes.transpose() * (0.5 * (low + high) - to_eigen(from.origin));
  const Vec3 half = axes.cwiseAbs().transpose() * (0.5 * (high - low));
  const double slack = 1e-9 * half.maxCoeff();  // for rounding
  return {centre.array() - half.array() - slack, centre.array() + half.array() + slack};
}

/// Where edges of one surface pass through another: the middle of the part inside. Two bodies that meet edge across
/// edge have no corner in each other.
template <class From, class Onto, class Surface>
void list_edge_points(const From& from, const Onto& onto, const Surface& a, const Surface& b,
                      const surface::Bounds& box, std::vector<BodyPoint>& points) {
  from.edges(box, [&](std::uint32_t number, const Vector3<double>& tail, const Vector3<double>& head) {
    const auto seen = [&](const Vector3<double>& p) {
      return transpose_times(b.axes, a.origin + a.axes * p - b.origin);
    };
    double first = 0.0, last = 1.0;
    if (!onto.clip(seen(tail), seen(head), first, last)) return;
    // Where a corner is inside it is the point; as it comes out, the edge takes over.
    const double outside = min(first, 1.0 - last);
    if (outside <= 0.0) return;
    points.push_back(
        {number, tail + 0.5 * (first + last) * (head - tail), 0.0, min(1.0, 4.0 * outside / (last - first))});
  });
}

/// Where round edges come nearest to another surface, along the ways in which a ball around them finds it. Points that
/// are spread over a rim (all those listed so far) fade out near it, so that a wheel rolls evenly.
template <class From, class Onto, class Surface>
void list_rim_points(const From& from, const Onto& onto, const Surface& a, const Surface& b,
                     std::vector<BodyPoint>& points) {
  const std::size_t spread = points.size();
  const double third = from.bounding_radius() / 3.0;
  std::uint32_t place = 0;
  onto.touch(transpose_times(b.axes, a.origin - b.origin), from.bounding_radius(),
             [&](std::uint32_t, const Vector3<double>& normal, double) {
               const Vector3<double> way = transpose_times(a.axes, b.axes * normal);
               from.rims(way, [&](std::uint32_t number, const Vector3<double>& p) {
                 for (std::size_t k = 0; k < spread; ++k) {
                   const Vector3<double> d = points[k].place - p;
                   const double height = dot(d, way), ratio = (dot(d, d) - height * height) / (third * third);
                   points[k].weight *= ratio * ratio / (1.0 + ratio * ratio);
                 }
                 points.push_back({number + 2 * place, p, 0.0, 1.0});
               });
               ++place;
             });
}

/// The points of `from` that may touch `onto`.
template <class Surface>
void list_points(const Surface& from, const Surface& onto, std::vector<BodyPoint>& points) {
  points.clear();
  const surface::Bounds box = shared_box(from, onto);
  std::visit(
      [&]<class From, class Onto>(const From& a, const Onto& b) {
        if constexpr (HasPoints<From>) {
          a.points(box, [&](std::uint32_t number, const Vector3<double>& p, double radius) {
            points.push_back({number, p, radius, 1.0});
          });
        }
        if constexpr (HasRims<From>) list_rim_points(a, b, from, onto, points);
        if constexpr (HasEdges<From> && ClipsLines<Onto>) list_edge_points(a, b, from, onto, box, points);
      },
      from.geometry, onto.geometry);
}

}  // namespace dem::pipeline
