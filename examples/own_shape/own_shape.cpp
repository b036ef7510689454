// A shape of one's own: a capsule, the set of points within `radius` of a line of length 2 `half`. Two capsules touch
// where their lines are nearest to each other. One that lies across a slope rolls down it; two that cross on a plane
// bear each other.

#include <dem/dem.hpp>

#include <algorithm>
#include <numbers>

class Capsule {
 public:
  static constexpr int pose_size = 3;  // what is cached for each grain: half the line, in global axes
  static constexpr bool has_orientation = true;
  static constexpr std::size_t most_contacts = 1;
  template <class T>
  using PairTouch = dem::contact::PointTouch<T>;
  using V = dem::Vector3<double>;

  Capsule(double half, double radius)  // m; the frame is in the middle, the line along z
      : half_(dem::require_positive(half, "half length of a capsule", "m")),
        radius_(dem::require_positive(radius, "radius of a capsule", "m")) {}

  double bounding_radius() const { return half_ + radius_; }
  double volume() const { return cylinder() + ball(); }
  dem::Vec3 unit_inertia() const {  // about the centre, of density 1: a cylinder and two half balls
    const double r2 = radius_ * radius_, along = (0.5 * cylinder() + 0.4 * ball()) * r2;
    const double across =
        cylinder() * (r2 / 4 + half_ * half_ / 3) + ball() * (0.4 * r2 + half_ * half_ + 0.75 * half_ * radius_);
    return {across, across, along};
  }

  DEM_HOT void orient(const dem::Matrix3<double>& rotation, double* pose) const {
    const V line = half_ * (rotation * V{0, 0, 1});
    pose[0] = line.x, pose[1] = line.y, pose[2] = line.z;
  }

  template <class Sink>
  static DEM_HOT void collide(const Capsule& a, const double* pose_a, const Capsule& b, const double* pose_b,
                              const V& separation, Sink&& sink) {
    // Nearest points s u and separation + t v of the lines, s and t from -1 to 1, by turns: each comes nearer by
    // the square of the cosine between the lines, and where they are nearly parallel any points will do.
    const V u = line(pose_a), v = line(pose_b);
    double s = 0.0, t = 0.0;
    for (int k = 0; k < 20; ++k) {
      s = std::clamp(dot(separation + t * v, u) / dot(u, u), -1.0, 1.0);
      t = std::clamp(dot(s * u - separation, v) / dot(v, v), -1.0, 1.0);
    }
    const V link = separation + t * v - s * u;
    const double distance = dem::max(norm(link), 1e-300), overlap = a.radius_ + b.radius_ - distance;
    if (!(overlap > 0.0)) return;
    const V normal = 1.0 / distance * link;
    sink(0u, PairTouch<double>{normal, overlap, s * u + (a.radius_ - 0.5 * overlap) * normal,
                               a.radius_ * b.radius_ / (a.radius_ + b.radius_), 1.0});
  }
  static std::uint32_t mirrored(std::uint32_t feature) { return feature; }

  template <class Sink>
  DEM_HOT void probe(const double* pose, Sink&& sink) const {  // on surfaces: the balls at its ends
    sink(0u, dem::contact::Probe{-line(pose), radius_, radius_});
    sink(1u, dem::contact::Probe{line(pose), radius_, radius_});
  }

 private:
  static V line(const double* pose) { return {pose[0], pose[1], pose[2]}; }
  double cylinder() const { return 2 * std::numbers::pi * half_ * radius_ * radius_; }
  double ball() const { return 4.0 / 3 * std::numbers::pi * radius_ * radius_ * radius_; }

  double half_, radius_;
};

struct Pills : dem::Model {
  using Shape = Capsule;
  using Integrator = dem::integrator::VelocityVerlet;
};

dem::Mat3 turned(const dem::Vec3& line) {  // the frame's z along a direction
  return dem::rotation_between(dem::Vec3::UnitZ(), line);
}

int main() {
  const double g = 9.81, half = 3e-3, radius = 1e-3, slope = 0.2;
  const dem::ContactParameters<Pills> sand = {.normal = {2000, 0.2, 1.0}, .friction = {0.6, 2000, 0.02, 0.975}};
  dem::World<Pills> world({.gravity = {g * std::sin(slope), 0, -g * std::cos(slope)}, .threads = 1});
  world.set_contact(sand);
  const auto pill = world.add_species(Capsule(half, radius));
  world.add_surface(world.ground(), dem::surface::Plane{});
  const auto roller =
      world.add_particle({.species = pill, .position = {0, 0, radius}, .rotation = turned(dem::Vec3::UnitY())});
  if (const auto report = world.run_for(0.3); !report) return fmt::print("{}\n", report.text), 1;
  const auto& kind = world.species(pill);
  const double expected = g * std::sin(slope) / (1 + kind.inertia.z() / (kind.mass * radius * radius));
  fmt::print("rolls with {:.4f} of g sin / (1 + I / m r^2)\n", world.velocity(roller).x() / (expected * world.time()));

  dem::World<Pills> pile({.gravity = {0, 0, -g}, .threads = 1});
  pile.set_contact(sand);
  pile.add_species(Capsule(half, radius));
  const auto floor = pile.add_surface(pile.ground(), dem::surface::Plane{});
  pile.add_particle({.species = pill, .position = {-2e-3, 0, radius}, .rotation = turned(dem::Vec3::UnitY())});
  pile.add_particle({.species = pill, .position = {2e-3, 0, radius}, .rotation = turned(dem::Vec3::UnitY())});
  const auto top =
      pile.add_particle({.species = pill, .position = {0, 0, 3 * radius}, .rotation = turned(dem::Vec3::UnitX())});
  if (const auto report = pile.run_for(0.5); !report) return fmt::print("{}\n", report.text), 1;
  fmt::print("a bridge of three weighs {:.6f} of 3 m g, and rests at {:.4f} of 3 r\n",
             -pile.surface_force(floor).z() / (3 * kind.mass * g), pile.position(top).z() / (3 * radius));
}
