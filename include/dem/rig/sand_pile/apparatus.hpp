#pragma once

#include <dem/rig/affordable.hpp>
#include <dem/rig/sand_pile/grains.hpp>
#include <dem/soil/lattice.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace dem::rig::sand_pile {

/// The apparatus: a plate (its upper side is z = 0, its middle the z axis) with a cylinder or a funnel over it, or a
/// box with a slot in its floor. `top` (m) is as high as the grains reach before they fall.
template <class Model>
class Apparatus {
  static_assert(std::is_constructible_v<typename Model::Surfaces, surface::Box> &&
                    std::is_constructible_v<typename Model::Surfaces, surface::Cylinder>,
                "the sand pile's apparatus is made of boxes and cylinders: name surface::Box and surface::Cylinder "
                "among the Model's Surfaces");

 public:
  using World = dem::World<Model>;

  Apparatus(const Settings& s, const Grains<Model>& kind, std::span<const soil::Placement> grains)
      : world({.time_step_safety = s.stable_share,
               .overlap_limit = 1.0,
               .threads = s.threads > 0 ? s.threads : threads_for(s.grains),
               .sleep = s.sleep ? std::optional<SleepOptions>(SleepOptions{}) : std::nullopt}),
        settings_(s) {
    const SpeciesId species = world.add_species(kind.shape, {.material = "grain", .density = s.density});
    world.set_contact("grain", "grain", kind.on_grain);
    world.set_contact("grain", "plate", kind.on_plate);
    world.set_contact("grain", "container", kind.on_container);
    double top = 0.0;
    for (const auto& g : grains) {
      world.add_grain({.species = species, .position = g.position, .rotation = g.rotation});
      top = std::max(top, g.position.z() + kind.shape.bounding_radius());
    }
    if (s.method == "drain") build_box(top);
    else build_plate();
    if (s.method == "lift") build_cylinder(top);
    if (s.method == "funnel") build_funnel(top);
  }

  /// Lifts the cylinder by a way (m) from a time on (s), at the lift speed at its most.
  void lift(double way, double start) {
    world.machine().set_motion(lift_, mbd::Signal::smooth_step(0.0, way, start, start + lift_time(way)));
  }
  /// s; the largest rate of a smooth step is 15/8 of its mean.
  double lift_time(double way) const { return 1.875 * way / settings_.lift_speed; }
  /// Opens the funnel or the slot.
  void open() { world.set_active(gate_, false); }
  /// Whether a grain is higher than the lower edge of the cylinder, which holds it in.
  bool cylinder_holds_grains() const {
    const double low = world.machine().body(cylinder_).position().z() - 0.5 * cylinder_length_;
    const auto grains = world.grains();
    return std::any_of(grains.begin(), grains.end(), [&](GrainId p) { return world.position(p).z() > low; });
  }
  /// Takes away the grains that have fallen far below the plate; returns how many.
  std::size_t remove_fallen() {
    std::size_t count = 0;
    for (const GrainId p : world.grains()) {
      if (world.position(p).z() > -12.0 * settings_.half_edge) continue;
      world.remove_grain(p);
      ++count;
    }
    return count;
  }

  World world;

 private:
  double wall() const { return 6.0 * settings_.half_edge; }  // m, thickness: no grain is pushed through

  void add_box(const char* name, const char* material, const Vec3& low, const Vec3& high) {
    const Vec3 edges = high - low, middle = 0.5 * (low + high);
    world.add_surface(world.ground(), surface::Box(edges), {.material = material, .name = name, .position = middle});
  }

  void build_plate() {
    const double r = settings_.plate_radius, t = wall(), h = settings_.half_edge;
    world.add_surface(world.ground(), surface::Cylinder(r, t),
                      {.material = "plate", .name = "plate", .position = {0.0, 0.0, -0.5 * t}});
    if (settings_.plate != "ridged") return;
    for (double ring = 3.0 * h; ring + h < r; ring += 6.0 * h) {
      world.add_surface(world.ground(), surface::Cylinder::tube(ring, ring + h, 2.0 * h),
                        {.material = "plate", .name = "ring"});
    }
  }

  /// It hangs over the rings by less than a grain.
  void build_cylinder(double top) {
    const double r = settings_.cylinder_radius, t = wall(), low = 1.2 * settings_.half_edge, length = top - low;
    const Vec3 middle(0.0, 0.0, low + 0.5 * length);
    cylinder_length_ = length;
    cylinder_ =
        world.machine().add_body(mbd::box_body("cylinder", {2.0 * (r + t), 2.0 * (r + t), length}, 1000.0).at(middle));
    world.add_surface(cylinder_, surface::Cylinder::tube(r, r + t, length),
                      {.material = "container", .name = "cylinder"});
    const JointId slide =
        world.machine().add_joint(mbd::prismatic("slide", world.ground(), cylinder_, middle, Vec3::UnitZ()));
    lift_ = world.machine().add_motion(mbd::prescribed_joint("lift", slide, 0.0));
  }

  /// A cone of twelve flat walls, a cylinder on it, and a gate under it.
  void build_funnel(double top) {
    const double r = settings_.orifice_radius, wide = settings_.cylinder_radius, z = settings_.orifice_height,
                 t = wall(), turn = settings_.funnel_angle_deg * std::numbers::pi / 180.0;
    const double slope = (wide - r) / std::sin(turn), high = z + (wide - r) / std::tan(turn);
    constexpr int walls = 12;
    for (int k = 0; k < walls; ++k) {
      const double a = 2.0 * std::numbers::pi * k / walls;
      const Vec3 out(std::cos(a), std::sin(a), 0.0), up = Vec3::UnitZ();
      Mat3 rotation;
      rotation.col(0) = std::cos(turn) * out - std::sin(turn) * up;
      rotation.col(1) = up.cross(out);
      rotation.col(2) = std::sin(turn) * out + std::cos(turn) * up;
      const Vec3 edges(t, 2.2 * wide * std::tan(std::numbers::pi / walls), slope);
      const Vec3 middle = 0.5 * (r + wide) * out + 0.5 * (z + high) * up + 0.5 * t * Vec3(rotation.col(0));
      world.add_surface(world.ground(), surface::Box(edges),
                        {.material = "container", .name = "funnel", .position = middle, .rotation = rotation});
    }
    const double length = std::max(top - high, 4.0 * settings_.half_edge);
    world.add_surface(world.ground(), surface::Cylinder::tube(wide, wide + t, length),
                      {.material = "container", .name = "funnel", .position = {0.0, 0.0, high + 0.5 * length}});
    gate_ = world.add_surface(world.ground(), surface::Cylinder(r + t, t),
                              {.material = "container", .name = "gate", .position = {0.0, 0.0, z - 0.5 * t}});
  }

  /// The floor from x = -box_length to 0, the slot behind it, and four walls.
  void build_box(double top) {
    const double l = settings_.box_length, w = 0.5 * settings_.box_width, slot = settings_.slot_width, t = wall(),
                 h = settings_.half_edge;
    add_box("floor", "plate", {-l - t, -w - t, -t}, {0.0, w + t, 0.0});
    add_box("back wall", "container", {-l - t, -w - t, 0.0}, {-l, w + t, top});
    add_box("front wall", "container", {slot, -w - t, -4.0 * t}, {slot + t, w + t, top});
    add_box("side wall", "container", {-l, -w - t, 0.0}, {slot, -w, top});
    add_box("side wall", "container", {-l, w, 0.0}, {slot, w + t, top});
    if (settings_.plate == "ridged") {
      for (double x = -3.0 * h; x - h > -l; x -= 6.0 * h) add_box("bar", "plate", {x - h, -w, 0.0}, {x, w, h});
    }
    gate_ = world.add_surface(world.ground(), surface::Box(Vec3(slot, 2.0 * (w + t), t)),
                              {.material = "container", .name = "gate", .position = {0.5 * slot, 0.0, -0.5 * t}});
  }

  Settings settings_;
  SurfaceId gate_;
  BodyId cylinder_;
  double cylinder_length_ = 0.0;  // m
  MotionId lift_;
};

/// m, how high above the plate the container begins: grains start above it.
inline double container_floor(const Settings& s) {
  if (s.method != "funnel") return s.plate == "ridged" ? s.half_edge : 0.0;  // the height of the bars
  const double turn = s.funnel_angle_deg * std::numbers::pi / 180.0;
  return s.orifice_height + (s.cylinder_radius - s.orifice_radius) / std::tan(turn);
}

/// The grains before they fall: a loose cloud in the container, each turned at random. Throws Error if it has no place
/// for one.
inline std::vector<soil::Placement> lattice(const Settings& s, double bounding_radius, std::uint64_t seed) {
  const bool round = s.method != "drain";
  const double lx = round ? 2.0 * s.cylinder_radius : s.box_length + s.slot_width,
               ly = round ? 2.0 * s.cylinder_radius : s.box_width;
  // Of a square's cells at least a quarter lie in the circle of a cylinder that is not narrower than resolve() makes
  // it, but of a last row that is not full none may.
  auto all = soil::random_lattice((round ? 5 : 1) * s.grains, s.half_edge, lx, ly, seed, 0.05, bounding_radius);
  std::vector<soil::Placement> grains;
  for (auto& g : all) {
    if (grains.size() == s.grains) break;
    const double out = std::hypot(g.position.x(), g.position.y());
    if (round && out > s.cylinder_radius - bounding_radius) continue;
    if (!round) g.position.x() += 0.5 * (s.slot_width - s.box_length);
    g.position.z() += container_floor(s);
    grains.push_back(g);
  }
  if (grains.size() == s.grains) return grains;
  if (all.back().position.z() < all.front().position.z() + bounding_radius) {
    fail(
        "--cylinder-radius is {:g} m, so wide that the lattice of {} grains of half-edge {:g} m is no layer on its "
        "floor; lower it, or give more --grains",
        s.cylinder_radius, s.grains, s.half_edge);
  }
  fail(
      "the container has no place for the lattice of {} grains of half-edge {:g} m; make it wider (--{}), or lower "
      "--grains",
      s.grains, s.half_edge, round ? "cylinder-radius" : "box-width");
}

}  // namespace dem::rig::sand_pile
