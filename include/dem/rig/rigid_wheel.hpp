#pragma once

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/rig/bed/make_bed.hpp>
#include <dem/rig/rigid_wheel/results.hpp>
#include <dem/rig/smooth_start.hpp>
#include <dem/world/contacts.hpp>

#include <utility>

namespace dem::rig {

/// The rigid wheel of thesis chapter 5 (table 5.2: bottom box, lid, carriage, shaft, wheel; prismatic joints of lid,
/// carriage and shaft, a revolute one of the wheel; linear actuators of lid and carriage, a rotary one of the wheel) on
/// grains of a Model, which has the thesis's laws and surface::Box, Cylinder and TriangleMesh among its Surfaces. The
/// carriage moves along +x and the wheel turns about +y, both at given speeds; shaft and wheel are a dead load.
///
/// One actuator more than in the table sets the wheel down, a load servo: a damper under which the load sinks at
/// the set-down speed, ever slower as the grains take it up. All slips start from copies of the bed with the wheel at
/// rest on it. Slip is s = 1 - v/(omega r).
///
///     dem::rig::rigid_wheel::Settings settings;
///     settings.size = "smoke";
///     dem::rig::RigidWheel<Sand> test(settings, [](double h) { return dem::shape::cube8(h); });
///     const auto stand = test.set_down(test.make_bed());
///     const auto run = test.roll(stand, 0.3);
///     run.pull.mean;                                    // N
template <class M>
class RigidWheel {
 public:
  using Model = M;
  using Settings = rigid_wheel::Settings;
  using Shape = typename Model::Shape;

  /// A bed with the machine on it. A copy is the same one, to the last bit.
  struct Stand {
    Bed<Model> bed;
    BodyId carriage = {}, shaft = {}, wheel = {};
    JointId rail = {}, guide = {}, axle = {};
    ActuatorId drive = {}, servo = {}, motor = {};
    SurfaceId rim = {};
    SensorId grains = {}, drive_sensor = {}, motor_sensor = {};
  };

  /// `shape_of(half_edge)` makes the shape of the grains (m). Throws Error for settings that make no sense.
  template <class ShapeOf>
  RigidWheel(Settings settings, ShapeOf&& shape_of) : RigidWheel(resolved(std::move(settings)), shape_of, 0) {}

  [[nodiscard]] const Settings& settings() const { return settings_; }
  [[nodiscard]] const Shape& shape() const { return shape_; }

  /// The levelled bed, of these grains, by default rained ones.
  [[nodiscard]] Bed<Model> make_bed(const soil::Packing& start, Stages& stages) const {
    return rig::make_bed<Model>(settings_.bed, settings_.grains, shape_, false, start, stages);
  }
  [[nodiscard]] Bed<Model> make_bed() const {
    Stages quiet;
    return make_bed(bed_grains(settings_.bed, settings_.grains, shape_.volume(), shape_.bounding_radius()), quiet);
  }

  /// Puts the machine over a bed and lowers the wheel, until the grains carry it within 2 % and it rests (both for 10
  /// ms). Then the servo is off.
  [[nodiscard]] Stand set_down(Bed<Model> bed) const {
    Stages quiet;
    return set_down(std::move(bed), quiet);
  }
  [[nodiscard]] Stand set_down(Bed<Model> bed, Stages& stages) const {
    const Settings& s = settings_;
    Stand stand = build(std::move(bed));
    auto& world = stand.bed.world;
    const auto& m = world.machine();
    stages.begin("set down", 1.0);
    const auto kept = stages.keep("bed", stand.bed);
    soil::Pressing n{world.time(), s.set_down_speed};
    const auto stage = stages.enter(world, n);
    while (stage && !n.done) {
      run(world, 1e-3);
      const double force = m.sensor(stand.grains).mean().force.z;
      n.look(world.time(), force / s.load, m.body(stand.shaft).velocity().z());
      stages.update(std::clamp(force / s.load, 0.0, 1.0),
                    text("{:.1f} N, {:.2f} mm deep", force, 1e3 * sinkage(stand)));
      if (!n.done && world.time() - n.start > s.bed.stage_limit) {
        throw Stopped(
            text("the wheel is not at rest after {:g} s: the grains carry {:.4g} N of {:.4g} N; raise "
                 "--stage-limit or --set-down-speed",
                 s.bed.stage_limit, force, s.load));
      }
    }
    world.machine().switch_on(stand.servo, false);
    return stand;
  }

  /// Depth (m) of the wheel's lowest point, without grousers, below the mean surface of the bed.
  [[nodiscard]] double sinkage(const Stand& stand) const {
    return stand.bed.level - (stand.bed.world.machine().body(stand.wheel).position().z() - settings_.radius);
  }

  /// Rolls the wheel at a slip, on one thread, and evaluates its samples.
  [[nodiscard]] rigid_wheel::SlipResult roll(const Stand& stand, double slip) const {
    rigid_wheel::SlipResult result{.slip = slip};
    Stages quiet;
    roll(stand, 1, result, quiet, [](const auto&, double) {});
    rigid_wheel::evaluate(result, stand.bed.level, settings_);
    return result;
  }

  /// The same on so many threads, with stages that are told the share of the run, and look(world, share) after each
  /// sample. `result` is filled as the run goes; its samples are not evaluated. Throws Error for a slip at which the
  /// wheel would leave the bed.
  template <class Look>
  void roll(Stand stand, int threads, rigid_wheel::SlipResult& result, Stages& stages, Look&& look) const {
    const Settings& s = settings_;
    require_within(result.slip, -5.0, 1.0, "the slip of a run (1 - v/(omega r))");
    if (!(s.start() + s.travel_at(result.slip) + 0.5 * s.radius < 0.5 * s.bed.length)) {
      fail(
          "at slip {:g} the wheel travels {:g} m from {:g} m, and leaves a bed that ends at {:g} m; give the settings "
          "this slip too, a longer bed, or a shorter travel or path",
          result.slip, s.travel_at(result.slip), s.start(), 0.5 * s.bed.length);
    }
    auto& world = stand.bed.world;
    world.set_threads(threads);
    auto& m = world.machine();
    const double interval = s.sample_interval(), speed = (1.0 - result.slip) * s.rim_speed(),
                 duration = s.duration_at(result.slip);
    rigid_wheel::Rolling n{world.time(), m.coordinate(stand.rail), m.coordinate(stand.axle)};
    const auto stage = stages.enter(world, n, [&] {
      m.set_target(stand.drive, smooth_start(speed, s.ramp_time, n.start, n.rail));
      m.set_target(stand.motor, smooth_start(s.spin(), s.ramp_time, n.start, n.axle));
    });
    if (!stage) return;
    while (world.time() - n.start < duration) {
      run(world, interval);
      const auto& grains = m.sensor(stand.grains).mean();
      const double rim = m.speed(stand.axle) * s.radius, way = m.speed(stand.rail);
      result.samples.push_back({world.time() - n.start, 1.0 - way / rim, m.coordinate(stand.rail) - n.rail,
                                grains.force.x, -grains.torque.y, sinkage(stand), grains.force.z,
                                -m.sensor(stand.drive_sensor).mean().force.x,
                                m.sensor(stand.motor_sensor).mean().force.x});
      const double share = (world.time() - n.start) / duration;
      if (share > 0.5 && result.samples.size() % 2 == 0) look_under(stand, result.print);
      look(std::as_const(world), share);
      stages.update(std::min(1.0, share), text("slip {:g}: pull {:.1f} N", result.slip, grains.force.x));
      use_free_threads(world, stages);
    }
    // Behind the wheel, and not where it was set down.
    const double chord = std::sqrt(2.0 * s.radius * std::max(sinkage(stand), s.grains.edge()));
    rigid_wheel::find_rut(soil::placements(world), s, s.start(), s.start() + m.coordinate(stand.rail) - chord, result);
    result.finished = true;
  }

 private:
  template <class ShapeOf>
  RigidWheel(Settings settings, ShapeOf&& shape_of, int)
      : settings_(std::move(settings)), shape_(shape_of(settings_.grains.half_edge)) {}
  static Settings resolved(Settings s) {
    rigid_wheel::resolve(s);
    return s;
  }

  /// Adds what the grains do to the wheel at this moment to a print.
  void look_under(const Stand& stand, rigid_wheel::ContactPrint& print) const {
    if (print.across == 0) print.set_up(settings_.radius, settings_.width, settings_.grains.edge());
    const auto& world = stand.bed.world;
    const Vec3 middle = world.machine().body(stand.wheel).position();
    for (const auto& contact : contacts_of(world)) {
      if (contact.kind != ContactKind::grain_on_surface || contact.surface != stand.rim) continue;
      print.add(contact.point - middle, -contact.force);
    }
    print.moments += 1.0;
  }

  [[nodiscard]] Stand build(Bed<Model> bed) const {
    const Settings& s = settings_;
    Stand stand{.bed = std::move(bed)};
    auto& world = stand.bed.world;
    auto& m = world.machine();
    double top = stand.bed.level;
    for (const auto p : world.grains()) top = std::max(top, world.position(p).z() + shape_.bounding_radius());
    const Vec3 at(s.start(), 0.0, top + s.outer_radius());
    Mat3 about_y;  // the wheel's axis, z of its own frame, along y
    about_y << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    const double mass = s.load / 9.81, wheel_mass = s.wheel_share * mass;
    const double volume = std::numbers::pi * s.radius * s.radius * s.width;
    const auto box = [&](const char* name, double kg) {
      const Vec3 edges(0.05, 0.05, 0.05);
      return m.add_body(mbd::box_body(name, edges, kg / edges.prod()).at(at));
    };
    stand.carriage = box("carriage", s.carriage_mass);
    stand.shaft = box("shaft", mass - wheel_mass);
    stand.wheel = m.add_body(mbd::cylinder_body("wheel", s.radius, s.width, wheel_mass / volume).at(at, about_y));
    world.set_contact("grain", "wheel", grain_contact<Model>(s.grains, s.wheel_friction));
    const SurfaceOptions as_wheel = {.material = "wheel", .name = "wheel"};
    if (s.wheel == "grousers") {
      const mesh::Wheel shape = {.radius = s.radius,
                                 .width = s.width,
                                 .grousers = s.grousers,
                                 .grouser_height = s.grouser_height,
                                 .grouser_thickness = s.grouser_thickness};
      stand.rim = world.add_surface(stand.wheel, surface::TriangleMesh(mesh::wheel(shape)), as_wheel);
    } else {
      stand.rim = world.add_surface(stand.wheel, surface::Cylinder(s.radius, s.width), as_wheel);
    }
    stand.rail = m.add_joint(mbd::prismatic("rail", m.ground(), stand.carriage, at, Vec3::UnitX()));
    stand.guide = m.add_joint(mbd::prismatic("guide", stand.carriage, stand.shaft, at, Vec3::UnitZ()));
    stand.axle = m.add_joint(mbd::revolute("axle", stand.shaft, stand.wheel, at, Vec3::UnitY()));
    const double k = s.drive_stiffness, turn = s.motor_stiffness, inertia = 0.5 * wheel_mass * s.radius * s.radius;
    stand.drive =
        m.add_actuator(mbd::joint_actuator("drive", stand.rail, k, 2.0 * std::sqrt(k * (mass + s.carriage_mass))));
    stand.motor = m.add_actuator(mbd::joint_actuator("motor", stand.axle, turn, 2.0 * std::sqrt(turn * inertia)));
    stand.servo = m.add_actuator(mbd::joint_actuator("load servo", stand.guide, 0.0, s.load / s.set_down_speed));
    const double window = s.sample_interval();
    stand.grains = m.add_sensor(mbd::contact_sensor("grains on the wheel", stand.wheel, window));
    stand.drive_sensor = m.add_sensor(mbd::actuator_sensor("force of the drive", stand.drive, window));
    stand.motor_sensor = m.add_sensor(mbd::actuator_sensor("torque of the motor", stand.motor, window));
    return stand;
  }

  Settings settings_;
  Shape shape_;
};

}  // namespace dem::rig
