#pragma once

#include <dem/core/error.hpp>
#include <dem/domain/periodic.hpp>

namespace dem::domain {

/// A periodic cell in steady shear without walls: the cells above and below go by, along x (Lees and Edwards, J. Phys.
/// C 5, 1921, 1972). A grain that leaves through the upper border comes in through the lower one as much slower as the
/// cells go by, and where the cell below is by then. So grains flow with dv_x/dz = the shear rate in the mean, anywhere
/// alike, which no wall does. The cell repeats itself along x and z at least, and has no surfaces.
///
///     struct Sand : dem::Model { using Domain = dem::domain::Sheared; };
///     dem::World<Sand> world({.gravity = Vec3::Zero(), .domain = {{{0, 0, 0}, {0.1, 0.1, 0.1}}},
///                             .periodic = {.x = true, .y = true, .z = true}, .shear_rate = 20.0});
///     ... world.add_grain({.position = x, .velocity = {20.0 * (x.z() - 0.05), 0, 0}});
///
/// World::set_shear_rate changes it. Momentum along y and z is kept; along x it changes as grains cross borders, for
/// which borders a cell has is for the observer to say.
class Sheared : public Periodic {
 public:
  using Cell = Sheared;

  Sheared() = default;
  Sheared(const surface::Aabb& cell, const std::array<bool, 3>& repeats) : Periodic(cell, repeats) {}

  double shear_rate() const { return rate_; }  ///< 1/s, dv_x/dz
  /// From a time (s) on.
  void set_shear_rate(double rate, double time) {
    move_to(time);
    from_offset_ = offset_, from_ = time, rate_ = rate;
  }
  /// The cells around are where they are at a time (s).
  void move_to(double time) { offset_ = from_offset_ + slip() * (time - from_); }

  double slip() const { return rate_ * period()[2]; }  ///< m/s, of the cell above
  double offset() const { return offset_; }            ///< m, by which the cell above has gone, without end

  /// How many cells above this one a point is; as wrapped() rounds.
  double level_of(const Vector3<double>& x) const {
    if (x.z >= low(2) && x.z < low(2) + period()[2]) return 0.0;
    const double level = std::floor((x.z - low(2)) / period()[2]);
    return x.z - level * period()[2] < low(2) + period()[2] ? level : level + 1.0;
  }
  /// The shift (m) that puts a point some levels up, and there into the cell along x.
  Vector3<double> shift_to(const Vector3<double>& x, int level) const {
    const Vector3<double> there = {x.x + level * offset_, x.y, low(2)};
    return {Periodic::wrapped(there).x - x.x, 0.0, level * period()[2]};
  }

  Vector3<double> wrapped(Vector3<double> x) const {
    const double level = level_of(x);
    if (level != 0.0 && std::isfinite(level)) x.x -= level * offset_;
    return Periodic::wrapped(x);
  }
  template <class F>
  void for_each_image(const Vec3& x, F&& f) const {
    const double length = period()[0], offset = offset_ - length * std::round(offset_ / length);
    Periodic::for_each_image(x, [&](const Vec3& image) {
      f(Vec3(image.x() + offset * std::round((image.z() - x.z()) / period()[2]), image.y(), image.z()));
    });
  }
  Vector3<double> beside(Vector3<double> x, const Vector3<double>& y) const {
    x.x += offset_ * std::round((y.z - x.z) / period()[2]);
    return Periodic::beside(x, y);
  }

  template <class V>
  void fields(V& v) {
    Periodic::fields(v);
    v("shear_rate", rate_, "1/s"), v("since", from_, "s"), v("offset_then", from_offset_, "m"),
        v("offset", offset_, "m");
  }

 private:
  double rate_ = 0.0, from_ = 0.0, from_offset_ = 0.0, offset_ = 0.0;
};

}  // namespace dem::domain
