#pragma once

#include <dem/coupling/body_shapes.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace dem::coupling {

/// A point of one surface that may touch another.
struct BodyPoint {
  std::uint32_t number;
  Vector3<double> place;  ///< m, in the frame of its own surface
  double radius;          ///< m, of a ball; 0 for a point
  double weight;
};

/// The box (in the frame of `from`) that both surfaces' bounding boxes share.
template <class Surface>
surface::Aabb shared_box(const Surface& from, const Surface& onto) {
  const Vec3 low = upper(from.low, onto.low), high = lower(from.high, onto.high);
  const Mat3 axes = to_eigen(from.axes);
  const Vec3 centre = axes.transpose() * (0.5 * (low + high) - to_eigen(from.origin));
  const Vec3 half = transposed(magnitudes(axes)) * (0.5 * (high - low));
  const double slack = 1e-9 * half.maxCoeff();  // for rounding
  return {centre - half - filled(slack), centre + half + filled(slack)};
}

/// Finds the points of one surface (`From`, a geometry) that may touch another one (`Onto`): those that the surface is
/// made of, and those that come nearest to the other.
template <class From, class Onto, class Surface>
class PointsTowards {
 public:
  PointsTowards(const From& from, const Onto& onto, const Surface& a, const Surface& b, std::vector<BodyPoint>& points)
      : from_(from), onto_(onto), a_(a), b_(b), points_(points) {}

  void list() {
    points_.clear();
    const surface::Aabb box = shared_box(a_, b_);
    if constexpr (surface::HasPoints<From>) {
      from_.points(box, [&](std::uint32_t number, const Vector3<double>& p, double radius) {
        points_.push_back({number, p, radius, 1.0});
      });
    }
    const std::size_t spread = points_.size();
    if constexpr (surface::HasRims<From>) list_rims(spread);
    if constexpr (surface::IsSuperquadric<From>) list_deepest(spread);
    if constexpr (surface::HasLateralSurface<From> && surface::ClipsLines<Onto>) list_lateral();
    if constexpr (surface::HasEdges<From> && (surface::ClipsLines<Onto> || surface::PartsLines<Onto>)) list_edges(box);
  }

 private:
  /// Numbers of points that are found, beyond those of a surface's own points, ascending. Each rim has as many as there
  /// are walls of the other surface that can be told apart.
  static constexpr std::uint32_t first_near = 1u << 20, of_a_rim = 1u << 18,
                                 first_of_lateral = first_near + 4 * of_a_rim;
  static constexpr std::uint32_t most_ways = 16;

  struct Way {
    std::uint32_t number;   ///< from 0 on, ascending: of the wall that it leads to, whichever others are near
    Vector3<double> along;  ///< into the other surface, own frame
    std::uint32_t wall;     ///< family of the other surface's features
    double gap;             ///< m
  };
  struct Ways {
    std::array<Way, most_ways> way;
    std::uint32_t count = 0;
    std::span<const Way> all() const { return {way.data(), count}; }
    bool is_only_one_to(std::uint32_t wall) const {
      return std::count_if(way.begin(), way.begin() + count, [&](const Way& w) { return w.wall == wall; }) == 1;
    }
  };

  struct Place {
    double gap;              ///< m, to the other surface; 1e300: out of reach
    Vector3<double> normal;  ///< into the other surface, own frame
  };

  Vector3<double> seen(const Vector3<double>& p) const {
    return transpose_times(b_.axes, a_.origin + a_.axes * p - b_.origin);
  }
  /// callback(wall, normal, gap) for all contacts of a ball at p, in the own frame.
  template <class Callback>
  void contacts(const Vector3<double>& p, double radius, Callback&& callback) const {
    onto_.contacts(seen(p), radius, [&](std::uint32_t feature, const Vector3<double>& normal, double gap) {
      callback(surface::family_of<Onto>(feature), transpose_times(a_.axes, b_.axes * normal), gap);
    });
  }
  /// The directions in which a ball at p meets the other surface; the nearest ones if they are too many.
  Ways find_ways(const Vector3<double>& p, double radius) const {
    Ways ways;
    contacts(p, radius, [&](std::uint32_t wall, const Vector3<double>& normal, double gap) {
      if (ways.count == most_ways) {
        const auto farthest = std::max_element(ways.way.begin(), ways.way.end(),
                                               [](const Way& a, const Way& b) { return a.gap < b.gap; });
        if (gap >= farthest->gap) return;
        std::copy(farthest + 1, ways.way.end(), farthest);
        --ways.count;
      }
      ways.way[ways.count++] = {0, normal, wall, gap};
    });
    std::uint32_t next = 0;
    for (Way& way : std::span(ways.way.data(), ways.count)) {
      way.number = std::max(next, std::min(way.wall, of_a_rim / most_ways - 1) * most_ways);
      next = way.number + 1;
    }
    return ways;
  }
  /// Where a ball at p meets the other surface, or one wall of it, first.
  static constexpr std::uint32_t any_wall = ~0u;
  Place nearest(const Vector3<double>& p, double radius, std::uint32_t of = any_wall) const {
    Place best = {1e300, {0, 0, 0}};
    contacts(p, radius, [&](std::uint32_t wall, const Vector3<double>& normal, double gap) {
      if (gap < best.gap && (of == any_wall || wall == of)) best = {gap, normal};
    });
    return best;
  }
  void add(std::uint32_t number, const Vector3<double>& p, double weight = 1.0) {
    points_.push_back({number, p, 0.0, weight});
  }
  /// Sample points of a round surface (the first `spread` points of the list) lose their weight near p, the point that
  /// is nearest to the other surface. So a body rolls evenly on that point alone. `third`: m, a third of the radius;
  /// at this distance from p, across `way`, half of the weight is left.
  void fade(std::size_t spread, const Vector3<double>& p, const Vector3<double>& way, double third) {
    for (std::size_t k = 0; k < spread; ++k) {
      const Vector3<double> d = points_[k].place - p;
      const double height = dot(d, way), ratio = (dot(d, d) - height * height) / (third * third);
      points_[k].weight *= ratio * ratio / (1.0 + ratio * ratio);
    }
  }

  /// Points of rims. A ball in the middle of a rim finds the directions to the other surface; the point of the rim that
  /// is farthest in each direction is taken.
  void list_rims(std::size_t spread) {
    from_.rims([&](std::uint32_t rim, const Vector3<double>& middle, double radius) {
      const Ways ways = find_ways(middle, radius);
      for (const Way& way : ways.all()) {
        const double across = std::sqrt(way.along.x * way.along.x + way.along.y * way.along.y);
        if (across < 1e-9) continue;
        const Vector3<double> p = middle + (radius / across) * Vector3<double>{way.along.x, way.along.y, 0.0};
        fade(spread, p, way.along, radius / 3.0);
        add(first_near + of_a_rim * rim + way.number, p);
      }
    });
  }

  /// Points of the lateral surface of a cylinder: they lie on the line that faces the other surface where the
  /// axis comes nearest to it. Part of this line lies inside the other surface. The middle of the part is the deepest
  /// point of cylinders that cross. Points near its two ends count where the line is as deep there, as between
  /// cylinders that lie side by side.
  void list_lateral() {
    if (!from_.has_points()) return;
    const double half = 0.5 * from_.length();
    const auto on_axis = [&](double share) { return nearest({0, 0, share * half}, 1e100); };
    double first = -1.0, last = 1.0;  // between them the distance, convex along the axis, is least
    for (int k = 0; k < 40; ++k) {
      const double one = (2.0 * first + last) / 3.0, other = (first + 2.0 * last) / 3.0;
      on_axis(one).gap < on_axis(other).gap ? last = other : first = one;
    }
    Vector3<double> low, high;
    if (!from_.lateral_line(on_axis(0.5 * (first + last)).normal, low, high)) return;
    first = 0.0, last = 1.0;
    if (!onto_.clip(seen(low), seen(high), first, last)) return;
    const auto place = [&](double t) {
      return low + (0.5 * (first + last) + 0.45 * t * (last - first)) * (high - low);
    };
    const auto depth = [&](double t) { return -nearest(place(t), 0.0).gap; };
    add(first_of_lateral, place(0.0));
    const double middle = max(1e-300, depth(0.0));
    std::uint32_t number = first_of_lateral;
    for (const double t : {-1.0, 1.0}) {
      const double share = max(0.0, min(1.0, depth(t) / middle)), square = share * share, fourth = square * square;
      add(++number, place(t), fourth * fourth);
    }
  }

  /// Where a straight edge passes through the other surface, the middle of each part of the edge that lies inside it.
  /// Two bodies that meet edge across edge have no corner in each other.
  void list_edges(const surface::Aabb& box) {
    from_.edges(box, [&](std::uint32_t number, const Vector3<double>& tail, const Vector3<double>& head) {
      const auto add_part = [&](double first, double last) {
        // Where a corner is inside it is the point; as it comes out, the edge takes over.
        const double outside = min(first, 1.0 - last);
        if (outside <= 0.0) return;
        add(number, tail + 0.5 * (first + last) * (head - tail), min(1.0, 4.0 * outside / (last - first)));
      };
      if constexpr (surface::ClipsLines<Onto>) {
        double first = 0.0, last = 1.0;
        if (onto_.clip(seen(tail), seen(head), first, last)) add_part(first, last);
      } else {
        const std::uint32_t end = number + surface::most_parts;
        onto_.parts_inside(seen(tail), seen(head), [&](double first, double last) {
          if (number == end) return;
          add_part(first, last);
          ++number;
        });
      }
    });
  }

  /// The point of a superquadric that lies deepest in the other surface. On another superquadric it is where both share
  /// a normal; on other surfaces it is where descend() ends, one for each wall that is near. A wall that is met in
  /// several directions (a corner of a mesh) has one for each: the point farthest in that direction.
  void list_deepest(std::size_t spread) {
    if (!from_.grain()) return;
    const auto& grain = *from_.grain();
    const double third = grain.mean_radius() / 3.0;
    if constexpr (surface::IsSuperquadric<Onto>) {
      if (onto_.grain()) {
        typename std::remove_cvref_t<decltype(grain)>::WarmStart found;
        const Vector3<double> centre = transpose_times(a_.axes, b_.origin - a_.origin);
        if (!grain.shares_normal(*onto_.grain(), transposed(a_.axes) * b_.axes, centre, found)) return;
        const Vector3<double> p = found.point + (0.5 * found.overlap) * found.normal;
        fade(spread, p, found.normal, third);
        add(first_near, p);
        return;
      }
    }
    const Ways ways = find_ways({0, 0, 0}, grain.bounding_radius());
    for (const Way& way : ways.all()) {
      Vector3<double> p = grain.even_support(upright, way.along);
      if (ways.is_only_one_to(way.wall)) p = descend(grain, p, way.wall);
      fade(spread, p, way.along, third);
      add(first_near + way.number, p);
    }
  }
  static constexpr double upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  /// Moves from a point of a convex surface to the one that lies deepest in a wall of the other surface, or comes
  /// nearest to it, by the method of Frank and Wolfe (1956, doi:10.1002/nav.3800030109). Each step goes along the chord
  /// to the point that is farthest in the direction of the other's normal. It stops on the chord where the gap is
  /// least, as the slopes of the gap at both ends tell. On a plane the first step is the last; between round bodies
  /// each step reduces the error of the gap by a factor.
  template <class Grain>
  Vector3<double> descend(const Grain& grain, Vector3<double> p, std::uint32_t wall) const {
    const double reach = 2.0 * grain.bounding_radius(), near = 1e-10 * grain.mean_radius();
    Place here = nearest(p, reach, wall);
    for (int k = 0; k < 30 && here.gap < reach; ++k) {
      const Vector3<double> end = grain.support(upright, here.normal), chord = end - p;
      const double fall = dot(here.normal, chord);
      if (!(fall > near)) break;
      const Place there = nearest(end, reach, wall);
      if (!(there.gap < reach)) break;
      const double rise = -dot(there.normal, chord);
      const Vector3<double> next = rise <= 0.0 ? end : p + (fall / (fall + rise)) * chord;
      const Place at_next = rise <= 0.0 ? there : nearest(next, reach, wall);
      if (!(at_next.gap < here.gap)) break;
      p = next;
      here = at_next;
    }
    return p;
  }

  const From& from_;
  const Onto& onto_;
  const Surface &a_, &b_;
  std::vector<BodyPoint>& points_;
};

/// The points of `from` that may touch `onto`.
template <class Surface>
void list_points(const Surface& from, const Surface& onto, std::vector<BodyPoint>& points) {
  std::visit([&]<class From, class Onto>(
                 const From& a, const Onto& b) { PointsTowards<From, Onto, Surface>(a, b, from, onto, points).list(); },
             from.geometry, onto.geometry);
}

}  // namespace dem::coupling
