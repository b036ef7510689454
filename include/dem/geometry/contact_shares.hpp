#pragma once

#include <dem/core/short_list.hpp>
#include <dem/geometry/contact_point.hpp>

#include <algorithm>
#include <cstddef>

namespace dem::contact {

/// When points are taken as one whole contact.
enum class Fit {
  always,   ///< however few there are
  if_more,  ///< where they are more than one; else they keep their weights
};

/// Weights points so that together they are one contact, as stiff as one.
/// - A point with weight w and overlap d gets w d / sum w d. The sum of the weights is 1. A point that only just
/// touches counts nothing, so no force jumps when points come and go.
/// - Points whose normals are at an angle are different contacts. In the sum of a point the others count with the
/// square of the cosine of that angle, and not at all beyond a right angle.
/// - With Fit::if_more points count as N = (sum w d)^2 / sum w d^2, which is n w for n points of equal depth. Up to N =
/// 1 they keep their weights; from N = 1 to N = 2 one rule goes over into the other.
/// - Across a gap (cohesion at a distance) the nearest point is the whole contact. It was the last one to part.
/// `point(k)` gives contact point k, of any of the types in contact_point.hpp.
///
/// Such shares have no potential, and none could have one. n equal points are as stiff as one. So a second point that
/// sinks to the depth of a first must do no work on the way, and yet push when it is there. Turning a body on its
/// points therefore gains or loses energy: in each cycle a share of what the contact stores, whatever the stiffness.
/// Dampers have to take more than that; "Why such contacts need damping" in ARCHITECTURE.md says how much.
template <class Point>
void fit_weights(std::size_t count, Fit fit, Point&& point) {
  // Points of flat faces have few normals, however many they are: their sums are over normals.
  struct Direction {
    Vector3<double> normal;
    double first = 0.0, second = 0.0;            // sums over its own points
    double first_near = 0.0, second_near = 0.0;  // with those of the other directions
  };
  struct Part {
    double part, overlap;  // m, the first times the weight, not negative
    std::size_t direction;
  };
  ShortList<Direction, 32> list_of_directions;
  ShortList<Part, 32> list_of_parts;
  auto& directions = list_of_directions.items;
  auto& parts = list_of_parts.items;
  parts.reserve(count);
  const auto direction_of = [&](const Vector3<double>& normal) {
    for (std::size_t k = directions.size(); k-- > 0;) {
      const Vector3<double> d = directions[k].normal - normal;
      if (dot(d, d) < 1e-24) return k;  // the same but for rounding
    }
    directions.push_back({normal});
    return directions.size() - 1;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const Geometry<double> g = point(k).geometry();
    const double depth = std::max(0.0, g.overlap);
    parts.push_back({depth * g.weight, g.overlap, direction_of(g.normal)});
    Direction& own = directions[parts.back().direction];
    own.first += parts.back().part;
    own.second += parts.back().part * depth;
  }
  for (Direction& d : directions) {
    const Vector3<double> normal = d.normal;
    double first = 0.0, second = 0.0;  // apart from what is read, which keeps them in registers
    for (const Direction& other : directions) {
      const double cosine = std::max(0.0, dot(normal, other.normal)), square = cosine * cosine;
      first += square * other.first;
      second += square * other.second;
    }
    d.first_near = first;
    d.second_near = second;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [normal, own_first, own_second, first, second] = directions[parts[k].direction];
    double& weight = point(k).weight;
    if (!(first > 0.0)) {
      if (!(parts[k].overlap < 0.0)) continue;
      bool nearest = true;
      for (std::size_t m = 0; m < count; ++m) {
        const bool nearer = parts[m].overlap > parts[k].overlap || (parts[m].overlap == parts[k].overlap && m < k);
        nearest &= !(nearer && dot(normal, directions[parts[m].direction].normal) > 0.0);
      }
      weight = nearest ? 1.0 : 0.0;
      continue;
    }
    const double whole = parts[k].part / first;
    if (fit == Fit::always) {
      weight = whole;
    } else if (const double n = first * first / second; n > 1.0) {
      const double over = std::min(1.0, n - 1.0);
      weight = (1.0 - over) * weight / n + over * whole;
    }
  }
}

/// What points that are shares of one contact add up to along the normal of point k (Geometry::total_share): their
/// springs push along it with the square of the cosine. A tiny number is added, so that nothing is divided by zero.
inline constexpr double least_total_share = 1e-12;
template <class Point>
double total_share(std::size_t count, std::size_t k, Point&& point) {
  const Vector3<double> normal = point(k).normal;
  double sum = least_total_share;
  for (std::size_t m = 0; m < count; ++m) {
    const double cosine = std::max(0.0, dot(normal, point(m).normal));
    sum += cosine * cosine * point(m).weight;
  }
  return sum;
}

}  // namespace dem::contact
