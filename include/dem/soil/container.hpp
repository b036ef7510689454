#pragma once

#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/plane/plane.hpp>
#include <dem/math/rotation.hpp>
#include <dem/world/options.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace dem::soil {

/// What a bed of grains lies in: open at the top, with the floor z = 0 and the middle x = y = 0.
class Container {
 public:
  /// An upright box; inner sizes in m. Throws Error unless they are positive.
  static Container box(double length_x, double length_y) { return trough(length_x, length_y, 0.0); }
  /// A trough along x: a flat floor of this width (m), and sides that lean outwards by `lean` (rad, from upright).
  /// Throws Error unless sizes are positive and the lean is from 0 to below 1.4 rad.
  static Container trough(double length_x, double floor_width, double lean) {
    Container c;
    c.length_ = require_positive(length_x, "length of a container along x", "m");
    c.width_ = require_positive(floor_width, "width of a container along y", "m");
    c.slope_ = std::tan(require_within(lean, 0.0, 1.4, "lean of a trough's sides (rad)"));
    return c;
  }
  /// An upright cylinder; inner radius in m. Throws Error unless it is positive.
  static Container cylinder(double radius) {
    Container c;
    c.radius_ = require_positive(radius, "radius of a container", "m");
    return c;
  }

  bool is_round() const { return radius_ > 0.0; }
  double length() const { return is_round() ? 2.0 * radius_ : length_; }  ///< m, along x
  /// m, along y at a height (m).
  double width(double z = 0.0) const { return is_round() ? 2.0 * radius_ : width_ + 2.0 * slope_ * std::max(z, 0.0); }
  /// m^2, of the section at a height (m).
  double area(double z = 0.0) const { return is_round() ? std::numbers::pi * radius_ * radius_ : length_ * width(z); }
  /// m^3, below a height (m).
  double volume(double z) const {
    const double h = std::max(z, 0.0);
    return is_round() ? area() * h : length_ * h * (width_ + slope_ * h);
  }
  /// m, from a place to the nearest wall or the floor; negative outside.
  double clearance(const Vec3& x) const {
    if (is_round()) return std::min(x.z(), radius_ - std::hypot(x.x(), x.y()));
    const double side = (0.5 * width_ + slope_ * x.z() - std::abs(x.y())) / std::sqrt(1.0 + slope_ * slope_);
    return std::min({x.z(), 0.5 * length_ - std::abs(x.x()), side});
  }

  /// Gives a world's ground the floor and the walls. Flat walls have no upper end; a round one has the height `top`
  /// (m). The world's surfaces must include planes, and cylinders for a round container. Returns the surfaces, floor
  /// first.
  template <class World>
  std::vector<SurfaceId> add_walls(World& world, double top, const std::string& material = "wall") const {
    std::vector<SurfaceId> walls;
    const auto plane = [&](const char* name, const Vec3& position, const Vec3& normal) {
      const Mat3 turn = rotation_between(Vec3::UnitZ(), normal);
      walls.push_back(world.add_surface(world.ground(), surface::Plane{},
                                        {.material = material, .name = name, .position = position, .rotation = turn}));
    };
    plane("floor", Vec3::Zero(), Vec3::UnitZ());
    if (is_round()) {
      walls.push_back(world.add_surface(world.ground(), surface::Cylinder::tube(radius_, 1.2 * radius_, top),
                                        {.material = material, .name = "wall", .position = Vec3(0, 0, 0.5 * top)}));
      return walls;
    }
    for (const double side : {-1.0, 1.0}) {
      plane(side < 0 ? "wall -x" : "wall +x", Vec3(0.5 * side * length_, 0, 0), Vec3(-side, 0, 0));
      plane(side < 0 ? "wall -y" : "wall +y", Vec3(0, 0.5 * side * width_, 0), Vec3(0, -side, slope_).normalized());
    }
    return walls;
  }

 private:
  double length_ = 0.0, width_ = 0.0, slope_ = 0.0, radius_ = 0.0;
};

}  // namespace dem::soil
