#pragma once
// The lane: troughs of grains in the ground, with the grains of a levelled bed in each.

#include <dem/geometry/box/box.hpp>
#include <dem/rig/bed/bed.hpp>
#include <dem/rig/soft_lane/results.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::soft_lane {

/// Without the grains where a step has hard ground, and those that would reach into it.
inline std::vector<soil::Placement> beyond_hard_ground(const Settings& s, std::vector<soil::Placement> grains) {
  const double reach = 0.5 * std::sqrt(3.0) * s.grains.edge();
  if (s.scene == "step") {
    std::erase_if(grains, [&](const auto& g) { return g.position.x() < s.border_at() + reach; });
  }
  return grains;
}

/// Grains of a levelled bed as they lie in the lane: as they are, or in two troughs, in the right one turned by half a
/// turn about z, so that both tracks are of the same soil but not mirror images.
/// None where there is hard ground.
inline std::vector<soil::Placement> lane_grains(const Settings& s, std::span<const soil::Placement> bed) {
  std::vector<soil::Placement> all;
  all.reserve(2 * bed.size());
  if (s.is_bed()) {
    all.assign(bed.begin(), bed.end());
    return beyond_hard_ground(s, std::move(all));
  }
  const Vec3 to_left(0, 0.5 * s.car.track(), 0);
  Mat3 half_turn = Mat3::Identity();
  half_turn(0, 0) = half_turn(1, 1) = -1.0;
  for (const auto& g : bed) all.push_back({g.position + to_left, g.rotation});
  for (const auto& g : bed) all.push_back({half_turn * g.position - to_left, half_turn * g.rotation});
  return beyond_hard_ground(s, std::move(all));
}

inline constexpr const char* hard_ground = "hard ground";    ///< a material and a surface
inline constexpr const char* second_grain = "second grain";  ///< a material

/// Species and contacts of the soil, and of the second soil if there is one (else the first again). Grains of the two
/// touch each other with the mean of their friction and cohesion. Throws Error for cohesion if the Model has none.
template <class Model>
std::array<SpeciesId, 2> add_soils(World<Model>& world, const Settings& s, const typename Model::Shape& shape) {
  const auto constants = [&](double friction, double cohesion) {
    ContactParameters<Model> c = grain_contact<Model>(s.grains, friction);
    const double weight = 9.81 * s.grains.density * shape.volume();
    if constexpr (requires { c.cohesion.force; }) {
      c.cohesion = {.force = cohesion * weight};  // at once: what comes on over a depth needs a smaller time step
    } else if (cohesion > 0.0) {
      fail("--second-cohesion is {:g}, but the grains of this model have no cohesion; it must be 0", cohesion);
    }
    return c;
  };
  const double mu = s.grains.friction;
  world.set_contact("grain", "wall", constants(s.grains.wall_friction, 0.0));
  world.set_contact("grain", "grain", constants(mu, 0.0));
  const SpeciesId first = world.add_species(shape, {.material = "grain", .density = s.grains.density});
  if (s.scene == "step") world.set_contact("grain", hard_ground, constants(s.grains.wall_friction, 0.0));
  if (s.scene != "soils") return {first, first};
  const char* second = second_grain;
  world.set_contact(second, "wall", constants(s.grains.wall_friction, 0.0));
  world.set_contact(second, "grain", constants(0.5 * (mu + s.second_friction), 0.5 * s.second_cohesion));
  world.set_contact(second, second, constants(s.second_friction, s.second_cohesion));
  return {first, world.add_species(shape, {.material = second, .density = s.grains.density})};
}

/// A world with the lane's walls and grains, without a car. Grains that leave it over the walls are taken out and
/// counted. `time_step` in s. Where the Model's Domain is periodic, it is one tile of a lane that goes along. Such a
/// lane itself has floor and side walls as far as the car drives; `to_come` grains are laid there later.
template <class Model>
World<Model> make_lane(const Settings& s, const typename Model::Shape& shape, std::span<const soil::Placement> grains,
                       double level, double time_step, std::size_t to_come = 0) {
  constexpr bool is_tile = Model::Domain::has_images;
  const double width = s.bed.width, t = s.bed.wall_thickness;
  const double low_x = -0.5 * (is_tile ? s.bed.length : s.length()), high_x = is_tile ? -low_x : s.ground_end();
  const double length = high_x - low_x, middle_x = 0.5 * (low_x + high_x);
  const double beyond = is_tile ? 4.0 * s.grains.edge() : t;  // m, of the floor: as far as images of grains reach
  const double track = s.is_bed() ? 0.0 : s.car.track(), top = level + 0.5;
  const double over_x = is_tile ? 0.0 : t, far_y = 0.5 * (track + width) + t;
  World<Model> world({.time_step = time_step,
                      .overlap_limit = 1.8,  // a grain that is jammed for a moment does not end a run; the report tells
                      .domain = surface::Aabb{Vec3(low_x - over_x, -far_y, -t), Vec3(high_x + over_x, far_y, top)},
                      .beyond_domain = BeyondDomain::remove,
                      .periodic = {.x = is_tile},
                      .threads = s.bed.threads > 0 ? s.bed.threads : threads_for(grains.size() + to_come),
                      .sleep = s.bed.sleep ? std::optional<SleepOptions>(SleepOptions{}) : std::nullopt});
  const std::array<SpeciesId, 2> soils = add_soils(world, s, shape);
  const BodyId ground = world.machine().add_body(mbd::fixed_body("lane"));
  const auto wall = [&](const std::string& name, const Vec3& edges, const Vec3& at) {
    world.add_surface(ground, surface::Box(edges), {.name = name, .position = at});
  };
  // Two edges above the mean surface, one above the highest grains: what a tyre pushes over it is lost.
  const double high = level + 2.0 * s.grains.edge(), middle = 0.5 * high;
  for (int k = 0; k < s.troughs(); ++k) {
    const double y = k == 0 ? 0.5 * track : -0.5 * track;
    const std::string name = s.is_bed() ? "bed" : k == 0 ? "left trough" : "right trough";
    wall(name + " floor", Vec3(length + 2.0 * beyond, width + 2.0 * t, t), Vec3(middle_x, y, -0.5 * t));
    for (const double side : {-1.0, 1.0}) {
      const std::string sign = side < 0.0 ? "-" : "+";
      if (!s.goes_along()) {
        wall(name + " wall " + sign + "x", Vec3(t, width + 2.0 * t, high), Vec3(side * 0.5 * (length + t), y, middle));
      }
      wall(name + " wall " + sign + "y", Vec3(is_tile ? length + 2.0 * beyond : length, t, high),
           Vec3(middle_x, y + side * 0.5 * (width + t), middle));
    }
  }
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const auto& g = grains[k];
    // Evenly spread over the second soil, by the golden ratio.
    const double draw = std::fmod(0.6180339887498949 * static_cast<double>(k), 1.0);
    const bool is_second = s.scene == "soils" && g.position.x() > s.border_at() && draw < s.second_share;
    world.add_grain({.species = soils[is_second ? 1 : 0], .position = g.position, .rotation = g.rotation});
  }
  return world;
}

/// The hard ground of a step, under both tracks and between them, level with the soil (m).
template <class Model>
SurfaceId add_hard_ground(World<Model>& world, const Settings& s, double level) {
  const double from = -0.5 * s.bed.length, to = s.border_at(), track = s.is_bed() ? 0.0 : s.car.track();
  const BodyId ground = world.machine().add_body(mbd::fixed_body(hard_ground));
  return world.add_surface(
      ground, surface::Box(Vec3(to - from, track + s.bed.width, level)),
      {.material = hard_ground, .name = hard_ground, .position = Vec3(0.5 * (from + to), 0, 0.5 * level)});
}

/// Mean height (m) of the surface of the lane, away from its walls: what sinkage and ruts are measured from.
inline double level_of(const Settings& s, std::span<const soil::Placement> grains) {
  const double away = s.grains.edge(), x = 0.5 * s.length() - away, y = 0.5 * s.bed.width - away;
  const double from = s.scene == "step" ? s.border_at() + away : -x;
  std::vector<SurfaceProfile> profiles;
  for (int k = 0; k < s.troughs(); ++k) {
    const double middle = s.is_bed() ? 0.0 : (k == 0 ? 0.5 : -0.5) * s.car.track();
    profiles.push_back(surface_profile(grains, s.grains.half_edge, from, x, middle - y, middle + y));
  }
  const double level = mean_surface(profiles);
  return std::isfinite(level) ? level : 0.0;
}

/// Overlap of the deepest contact in the last step, as a share of the edge of the cubes of 8 spheres. The world knows
/// it in effective diameters: the radius of two equal spheres, a quarter of the edge, and twice that of one on a
/// surface.
template <class Model>
double deepest_overlap(const World<Model>& world) {
  double deepest = 0.0;
  for (const auto& chunk : world.state().chunks) {
    deepest = std::max(deepest, chunk.deepest.overlap * (chunk.deepest.with_surface ? 0.5 : 0.25));
  }
  return deepest;
}

}  // namespace dem::rig::soft_lane
