#pragma once
// The car on the lane: how it is put there, moved on, and looked at.

#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>
#include <dem/rig/soft_lane/driver.hpp>
#include <dem/rig/soft_lane/lane.hpp>
#include <dem/rig/stages.hpp>
#include <dem/soil/moving_patch.hpp>
#include <dem/soil/rest.hpp>
#include <dem/vehicle/hitch.hpp>
#include <dem/vehicle/ring_wheels.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace dem::rig::soft_lane {

/// A body of a tyre, and the sensor of what the ground does to it: the wheel itself, or a segment of a ring.
struct TyrePart {
  BodyId body;
  SurfaceSensorId ground;
};

/// The lane with the car.
template <class Model>
struct Stand {
  World<Model> world;
  double level = 0.0;                        ///< m
  std::vector<soil::Placement> before = {};  ///< grains before the car came
  vehicle::Vehicle car = {};
  std::array<std::vector<TyrePart>, 4> tyres = {};
  std::array<std::optional<vehicle::RingTyre>, 4> rings = {};  ///< pneumatic tyres
  LoadId crane = {};
  std::optional<SurfaceId> hard = {};                  ///< ground, of a step
  std::shared_ptr<vehicle::Hitch> hitch = {};          ///< of a drawbar
  std::optional<soil::MovingPatch<Model>> patch = {};  ///< the grains of a lane that goes along

  /// What is kept of it besides world and car.
  template <class V>
  void fields(V& v) {
    v("level", level, "m"), v("before", before);
    if (patch) patch->fields(v);
  }
};

/// What lowering the car has come to, and how long it has stood on its brakes since.
struct SettingDown {
  double start = 0.0;                       ///< s
  soil::StaysBelow carried = {0.05, 0.03};  ///< by the crane, as a share of the weight
  bool done = false;
  int stood = 0;  ///< intervals
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("carried", carried), v("done", done), v("stood", stood);
  }
};

/// Tilting gravity: since when, and where the car stood.
struct Tilting {
  double start = 0.0, stood = 0.0;  ///< s, m
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("stood", stood, "m");
  }
};

/// Of a grain on a tyre: as grains on each other, but for the friction; the rubber of a ring is softer, and as damped.
template <class Model>
ContactParameters<Model> tyre_contact(const Settings& s) {
  GrainSettings g = s.grains;
  if (s.tyre == "ring") {
    const double share = s.tread_stiffness / (g.scale() * g.stiffness);
    g.stiffness *= share, g.friction_stiffness *= share;
    g.damping *= std::sqrt(share), g.velocity_stiffness *= std::sqrt(share);
  }
  return grain_contact<Model>(g, s.tyre_friction);
}

/// Gives a wheel its tyre: surfaces that touch the grains, and the hard ground if there is one.
template <class Model>
void add_tyre(Stand<Model>& stand, const Settings& s, const vehicle::Assembly& in, std::size_t corner) {
  auto& world = stand.world;
  const BodyId wheel = stand.car.wheels[corner].body;
  const vehicle::TyreSpec& tyre = stand.car.spec.tyre;
  const std::string name = vehicle::corner_names[corner];
  const auto part = [&](BodyId body, const auto& geometry, SurfaceOptions place, const std::string& part_name) {
    place.material = "tyre", place.name = part_name;
    const SurfaceId surface = world.add_surface(body, geometry, place);
    if (stand.hard) world.add_body_contact(surface, *stand.hard);
    stand.tyres[corner].push_back({body, world.add_surface_sensor(surface, interval)});
  };
  Mat3 about_y;  // the tyre's axis, z of its own frame, along y
  about_y << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (s.tyre == "mesh") {
    const IndexedMesh mesh = mesh::tyre(2.0 * tyre.radius, tyre.width, s.tyre_triangles);
    part(wheel, surface::TriangleMesh(mesh), {.rotation = about_y}, name + " tyre");
  } else if (s.tyre == "cylinder") {
    part(wheel, surface::Cylinder(tyre.radius, tyre.width), {.rotation = about_y}, name + " tyre");
  } else {
    const vehicle::RingTyre& ring =
        stand.rings[corner].emplace(vehicle::add_ring_tyre(in, stand.car, corner, s.ring()));
    for (std::size_t k = 0; k < ring.segments.size(); ++k) {
      part(ring.segments[k], surface::Box(to_eigen(ring.edges())), {}, name + " tyre " + std::to_string(k));
    }
  }
}

/// Mean force (N) and torque (N m, about the wheel's middle) of the ground on a wheel over the last interval.
template <class Model>
Wrench ground_on(const Stand<Model>& stand, std::size_t corner) {
  const auto& m = stand.world.machine();
  const Vector3<double> middle = m.body(stand.car.wheels[corner].body).motion.position;
  Wrench sum;
  for (const TyrePart& part : stand.tyres[corner]) {
    const Wrench w = stand.world.surface_sensor(part.ground).mean();
    sum = sum + Wrench{w.force, w.torque + cross(m.body(part.body).motion.position - middle, w.force)};
  }
  return sum;
}

/// Hangs the car over the lane: the wheels 0.2 m above the grains as the suspension is drawn, for they sink on their
/// springs. The crane sets it down.
template <class Model>
void add_car(Stand<Model>& stand, const Settings& s) {
  auto& m = stand.world.machine();
  double top = stand.level;
  for (const auto& g : stand.before) top = std::max(top, g.position.z() + s.grains.half_edge);
  const double step = stand.world.time_step(), car_step = step / std::ceil(step / s.machine_step * (1.0 - 1e-9));
  const vehicle::VehicleSpec car = s.tyre == "ring" ? vehicle::on_ring_tyres(s.car, s.ring(), car_step) : s.car;
  const double height = top + car.tyre.radius + 0.2 - s.car.front.points.wheel.z();
  m.joint_tolerance = 0.5;  // m: light shafts wind up; how far joints open is told with the results
  m.substeps = static_cast<int>(std::lround(step / car_step));
  const vehicle::Assembly in(m, "car", Vec3(s.start(), 0, height));
  stand.car = vehicle::add_vehicle(in, car);

  const ContactParameters<Model> on_tyre = tyre_contact<Model>(s);
  stand.world.set_contact("grain", "tyre", on_tyre);
  if (s.scene == "soils") stand.world.set_contact(second_grain, "tyre", on_tyre);
  if (stand.hard) {
    // Points of one body are one whole contact. A ring has its own stiffness; its light segments bear half as much.
    const bool is_ring = s.tyre == "ring";
    const double k = (is_ring ? 0.5 : 1.0) * car.tyre.stiffness, segment = s.ring().mass / s.ring().segments;
    const double c = is_ring ? 0.04 * std::sqrt(k * segment) : car.tyre.damping;
    stand.world.set_contact("tyre", hard_ground, {.normal = {k, c, 1.0}, .friction = {s.tyre_friction, k, c, 1.0}});
  }
  for (std::size_t corner = 0; corner < 4; ++corner) add_tyre(stand, s, in, corner);
  stand.crane = vehicle::add_crane(m, stand.car, s.set_down_speed);
  if (s.scene == "drawbar") stand.hitch = vehicle::add_hitch(m, stand.car, 0.6);
}

/// m, the middles of the wheels.
template <class Model>
std::array<Vec3, 4> wheels_of(const Stand<Model>& stand) {
  std::array<Vec3, 4> at;
  for (std::size_t k = 0; k < 4; ++k) at[k] = stand.world.machine().body(stand.car.wheels[k].body).position();
  return at;
}

/// Lays the tiles of a lane that goes along.
template <class Model>
void lay_patch(Stand<Model>& stand, const Settings& s, const soil::Tile& tile) {
  stand.patch.emplace(stand.world, tile,
                      soil::PatchOptions{.tiles = s.tiles,
                                         .corner = Vec3(-0.5 * s.length(), 0, 0),
                                         .rim = s.rim(),
                                         .ahead = s.ahead + s.car.tyre.radius,
                                         .rut_cell = s.grains.half_edge});
  stand.world.prepare();
  stand.before = soil::placements(stand.world);
  stand.level = level_of(s, stand.before);
}

/// Ten milliseconds with the driver's controls. Steering turns at `steer_rate` (rad/s) at most. Throws Stopped for a
/// step that shows a problem, Interrupted after Ctrl-C.
template <class Model>
void advance(Stand<Model>& stand, const vehicle::Controls& controls, double steer_rate = 0.5) {
  const double dt = stand.world.time_step();
  run(stand.world, interval, [&] { vehicle::drive(stand.world.machine(), stand.car, controls, dt, steer_rate); });
  if (!stand.patch) return;
  double front = -HUGE_VAL;
  for (const Vec3& wheel : wheels_of(stand)) front = std::max(front, wheel.x());
  stand.patch->follow(stand.world, front);
}

/// On a drawbar: the sled goes as fast as it is to, `time` (s) after the start.
template <class Model>
void pull(Stand<Model>& stand, const Settings& s, double time) {
  if (stand.hitch) stand.hitch->on = true, stand.hitch->speed = held_rims(s, time) * (1.0 - held_slip(s, time));
}

/// Where the car is along the lane, m: the mean of its wheels.
template <class Model>
double place_of(const Stand<Model>& stand) {
  const auto at = wheels_of(stand);
  return 0.25 * (at[0].x() + at[1].x() + at[2].x() + at[3].x());
}

/// Telemetry of the last interval. `time` (s) and `way` (m) since the start.
template <class Model>
Sample sample_of(const Stand<Model>& stand, const vehicle::Controls& controls, double time, double way, double radius) {
  const auto& m = stand.world.machine();
  Sample x;
  x.car = vehicle::sample_of(m, stand.car, controls, time);
  x.way = way;
  for (std::size_t j = 0; j < m.parts().joints.size(); ++j) {
    x.widest_joint = std::max(x.widest_joint, m.violation(JointId(j)).displacement);
  }
  x.hitch = stand.hitch ? stand.hitch->force : 0.0;
  x.overlap = deepest_overlap(stand.world);
  x.asleep = static_cast<double>(stand.world.asleep_count()) / static_cast<double>(stand.world.grain_count());
  for (std::size_t k = 0; k < 4; ++k) {
    const double deflection = stand.rings[k] ? vehicle::deflection_of(m, *stand.rings[k]) : 0.0;
    x.wheels[k] = vehicle::wheel_sample_of(m, stand.car, k, ground_on(stand, k), stand.level, radius, deflection);
    x.suspension[k] = vehicle::suspension_sample_of(m, stand.car, k);
  }
  return x;
}

/// Of the grains of a lane that goes along, where it is now, before the car came.
template <class Model>
std::vector<soil::Placement> untouched_patch(const soil::MovingPatch<Model>& patch) {
  std::vector<soil::Placement> all;
  const soil::Tile& tile = patch.tile();
  for (int k = 0; k < patch.tiles(); ++k) {
    const Vec3 corner(patch.back() + k * tile.period[0], 0, 0);
    for (const soil::TileGrain& g : tile.grains) {
      all.push_back({to_eigen(g.position) + corner, to_eigen(g.rotation)});
    }
  }
  return all;
}

/// The surface of the left (0) or right (1) track between where the rear wheels stood, or where the lane begins (m),
/// and a place (m) that they left, 0.2 m from both.
inline SurfaceProfile track_profile(const Settings& s, std::span<const soil::Placement> grains, std::size_t side,
                                    double begin, double rear) {
  double from = std::max(begin, s.start() + s.car.rear.points.wheel.x()) + 0.2;
  if (s.scene == "step") from = std::max(from, s.border_at() + 0.2);
  const double to = std::max(from, rear - 0.2);
  const double half = s.is_bed() ? 0.25 * s.bed.width : 0.5 * s.bed.width;
  const double middle = (side == 0 ? 1.0 : -1.0) * (s.is_bed() ? half : 0.5 * s.car.track());
  return surface_profile(grains, s.grains.half_edge, from, to, middle - half, middle + half);
}

/// Overlaps of all contacts of grains with grains under the wheels, in the box about each wheel's lowest point that is
/// as wide as the tyre, 0.3 m long, and down to the floor: as shares of a grain's edge. A search of its own.
template <class Model>
std::vector<double> overlaps_under_tyres(const Stand<Model>& stand, const Settings& s) {
  using Shape = typename Model::Shape;
  const auto& world = stand.world;
  std::vector<double> overlaps;
  for (const Vec3& wheel : wheels_of(stand)) {
    std::vector<GrainId> near;
    AlignedVector<double> pose;
    for (const GrainId p : world.grains()) {
      const Vec3 x = world.position(p) - wheel;
      if (std::abs(x.x()) > 0.15 || std::abs(x.y()) > 0.5 * s.car.tyre.width) continue;
      near.push_back(p);
      pose.resize(near.size() * Shape::pose_size + 1);
      world.species(world.species_of(p))
          .shape.orient(from_eigen(world.rotation(p)), &pose[(near.size() - 1) * Shape::pose_size]);
    }
    for (std::size_t i = 0; i < near.size(); ++i) {
      for (std::size_t j = i + 1; j < near.size(); ++j) {
        const Vec3 link = world.position(near[j]) - world.position(near[i]);
        if (link.squaredNorm() > 8.0 * s.grains.edge() * s.grains.edge()) continue;
        Shape::collide(
            world.species(world.species_of(near[i])).shape, &pose[i * Shape::pose_size],
            world.species(world.species_of(near[j])).shape, &pose[j * Shape::pose_size], from_eigen(link),
            [&](std::uint32_t, const auto& point) { overlaps.push_back(point.geometry().overlap / s.grains.edge()); });
      }
    }
  }
  return overlaps;
}

/// Mean height (m) of a field over half a tyre's width of the left (0) or right (1) track, from row `from` to `to`
/// along x; not known where no grain is.
inline double track_height(const soil::HeightField& field, const Settings& s, std::size_t side, std::size_t from,
                           std::size_t to) {
  const double middle = (side == 0 ? 0.5 : -0.5) * s.car.track();
  double sum = 0.0, count = 0.0;
  for (std::size_t k = from * field.across; k < to * field.across; ++k) {
    const double y = field.y0 + (static_cast<double>(k % field.across) + 0.5) * field.cell;
    if (std::abs(y - middle) < 0.25 * s.car.tyre.width && std::isfinite(field.z[k])) sum += field.z[k], count += 1.0;
  }
  return count > 0.0 ? sum / count : not_known;
}

/// The tracks of a lane that goes along, from where it began to where it ends now, and those of untouched tiles.
template <class Model>
void look_along(const Stand<Model>& stand, const Settings& s, Campaign& c) {
  const soil::HeightField field = stand.patch->surface(stand.world);
  const auto rows = static_cast<std::size_t>(std::max(1.0, std::round(0.5 / field.cell)));  // of a place
  c.along.assign(field.along() / rows, {});
  for (std::size_t p = 0; p < c.along.size(); ++p) {
    c.along[p].x = field.x0 + (static_cast<double>(p) + 0.5) * static_cast<double>(rows) * field.cell;
    for (std::size_t side = 0; side < 2; ++side) {
      c.along[p].z[side] = track_height(field, s, side, p * rows, (p + 1) * rows);
    }
  }
  soil::HeightField before = field;
  before.z.clear();
  const double volume = stand.world.state().species[0].shape.volume();
  for (const auto& g : stand.before) before.add(g.position, std::cbrt(0.75 * volume / std::numbers::pi));
  for (std::size_t side = 0; side < 2; ++side) {
    c.untouched_along[side] = track_height(before, s, side, 0, before.along());
  }
  c.tiles_laid = stand.patch->shifts();
  c.strays = static_cast<double>(stand.patch->strays());
}

/// What is seen of the lane at the end: ruts behind the rear wheels, and a section through the left wheels.
template <class Model>
void look_back(const Stand<Model>& stand, const Settings& s, Campaign& c) {
  const auto after = soil::placements(stand.world);
  c.wheel_at = wheels_of(stand);
  c.ends = {-0.5 * s.length(), 0.5 * s.length()};
  if (stand.patch) {
    c.ends = {stand.patch->back(), stand.patch->front()};
    look_along(stand, s, c);
  }
  const auto before = stand.patch ? untouched_patch(*stand.patch) : stand.before;
  for (std::size_t k = 0; k < 2; ++k) {
    c.before[k] = track_profile(s, before, k, c.ends[0], c.wheel_at[2].x());
    c.after[k] = track_profile(s, after, k, c.ends[0], c.wheel_at[2].x());
  }
  const double y = 0.5 * (c.wheel_at[0].y() + c.wheel_at[2].y());
  c.section.clear();
  for (const auto& g : after) {
    if (std::abs(g.position.y() - y) < s.grains.half_edge) c.section.push_back(g.position);
  }
  c.lost = static_cast<double>(stand.world.beyond_domain().grains());
}

}  // namespace dem::rig::soft_lane
