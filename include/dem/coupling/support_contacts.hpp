#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/contact_point.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dem::coupling {

/// Contacts of the support points of a grain with one surface. Each direction in which the grain meets the surface has
/// one support point: the point of the grain that is farthest in this direction. In a corner such a point may reach a
/// second wall as well. Each wall takes the contact of its own direction only. So the history of a contact goes by the
/// wall's name alone, whichever other walls are near.
class SupportContacts {
 public:
  struct Way {
    std::uint32_t family;   ///< of the surface's features, in which it was found (surface::family_of)
    Vector3<double> along;  ///< unit vector into the surface, global axes
    Vector3<double> point;  ///< m, from the grain's centre, global axes
  };
  struct ContactPoint {
    std::uint32_t feature, family;
    std::size_t way, owner;  ///< whose point it is, and whose wall
    contact::SurfaceContactPoint<double> point;
    bool is_spare = false;
  };

  void clear();
  void add_way(const Way& way) { ways_.push_back(way); }
  std::size_t way_count() const { return ways_.size(); }
  const Way& way(std::size_t k) const { return ways_[k]; }

  /// Adds a contact of the support point of a way. Its wall belongs to the way whose direction is nearest to the normal
  /// there; ways that found a wall of the same family go first.
  void add_point(std::size_t way, std::uint32_t family, std::uint32_t feature,
                 const contact::SurfaceContactPoint<double>& point);

  std::size_t bytes() const { return ways_.capacity() * sizeof(Way) + points_.capacity() * sizeof(ContactPoint); }

  /// The contacts in the order of their features, each with another number. Left out is one with a wall that the
  /// support point of its own way touches too.
  const std::vector<ContactPoint>& sorted();
  /// Whether a way has kept a contact.
  bool is_used(std::size_t way) const {
    return std::any_of(points_.begin(), points_.end(), [&](const ContactPoint& p) { return p.way == way; });
  }

 private:
  std::vector<Way> ways_;
  std::vector<ContactPoint> points_;
};

}  // namespace dem::coupling

#if DEM_DEFINES

namespace dem::coupling {

DEM_INLINE void SupportContacts::clear() {
  ways_.clear();
  points_.clear();
}

DEM_INLINE void SupportContacts::add_point(std::size_t way, std::uint32_t family, std::uint32_t feature,
                                           const contact::SurfaceContactPoint<double>& point) {
  const auto rank = [&](const Way& w) { return dot(w.along, point.normal) + (w.family == family ? 4.0 : 0.0); };
  std::size_t owner = way;
  for (std::size_t k = 0; k < ways_.size(); ++k) owner = rank(ways_[k]) > rank(ways_[owner]) ? k : owner;
  points_.push_back({feature, family, way, owner, point});
}

DEM_INLINE const std::vector<SupportContacts::ContactPoint>& SupportContacts::sorted() {
  if (ways_.size() < 2) return points_;
  for (ContactPoint& p : points_) {
    p.is_spare = p.way != p.owner && std::any_of(points_.begin(), points_.end(), [&](const ContactPoint& own) {
                   return own.way == p.owner && own.owner == p.owner && own.family == p.family;
                 });
  }
  std::erase_if(points_, [](const ContactPoint& p) { return p.is_spare; });
  std::sort(points_.begin(), points_.end(), [](const ContactPoint& a, const ContactPoint& b) {
    return a.feature != b.feature ? a.feature < b.feature : a.way < b.way;
  });
  for (std::size_t k = 1; k < points_.size(); ++k) {
    points_[k].feature = std::max(points_[k].feature, points_[k - 1].feature + 1u);
  }
  return points_;
}

}  // namespace dem::coupling

#endif
