#pragma once

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
class SupportTouches {
 public:
  struct Way {
    std::uint32_t family;   ///< of the surface's features, in which it was found (surface::family_of)
    Vector3<double> along;  ///< unit vector into the surface, global axes
    Vector3<double> point;  ///< m, from the grain's centre, global axes
  };
  struct ContactPoint {
    std::uint32_t feature, family;
    std::size_t way, owner;  ///< whose point it is, and whose wall
    contact::SurfaceContactPoint<double> touch;
    bool is_spare = false;
  };

  void clear() {
    ways_.clear();
    touches_.clear();
  }
  void add_way(const Way& way) { ways_.push_back(way); }
  std::size_t way_count() const { return ways_.size(); }
  const Way& way(std::size_t k) const { return ways_[k]; }

  /// Adds a touch of the support point of a way. Its wall belongs to the way whose direction is nearest to the normal
  /// there; ways that found a wall of the same family go first.
  void add_touch(std::size_t way, std::uint32_t family, std::uint32_t feature,
                 const contact::SurfaceContactPoint<double>& touch) {
    const auto rank = [&](const Way& w) { return dot(w.along, touch.normal) + (w.family == family ? 4.0 : 0.0); };
    std::size_t owner = way;
    for (std::size_t k = 0; k < ways_.size(); ++k) owner = rank(ways_[k]) > rank(ways_[owner]) ? k : owner;
    touches_.push_back({feature, family, way, owner, touch});
  }

  std::size_t bytes() const { return ways_.capacity() * sizeof(Way) + touches_.capacity() * sizeof(ContactPoint); }

  /// The touches in the order of their features, each with another number. Left out is a touch of a wall that the
  /// support point of its own way touches too.
  const std::vector<ContactPoint>& sorted() {
    if (ways_.size() < 2) return touches_;
    for (ContactPoint& t : touches_) {
      t.is_spare = t.way != t.owner && std::any_of(touches_.begin(), touches_.end(), [&](const ContactPoint& own) {
                     return own.way == t.owner && own.owner == t.owner && own.family == t.family;
                   });
    }
    std::erase_if(touches_, [](const ContactPoint& t) { return t.is_spare; });
    std::sort(touches_.begin(), touches_.end(), [](const ContactPoint& a, const ContactPoint& b) {
      return a.feature != b.feature ? a.feature < b.feature : a.way < b.way;
    });
    for (std::size_t k = 1; k < touches_.size(); ++k) {
      touches_[k].feature = std::max(touches_[k].feature, touches_[k - 1].feature + 1u);
    }
    return touches_;
  }
  /// Whether a way has kept a touch.
  bool is_used(std::size_t way) const {
    return std::any_of(touches_.begin(), touches_.end(), [&](const ContactPoint& t) { return t.way == way; });
  }

 private:
  std::vector<Way> ways_;
  std::vector<ContactPoint> touches_;
};

}  // namespace dem::coupling
