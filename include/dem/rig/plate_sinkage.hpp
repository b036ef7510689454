#pragma once

#include <dem/rig/bed/make_bed.hpp>
#include <dem/rig/plate_sinkage/results.hpp>
#include <dem/rig/smooth_start.hpp>

#include <utility>

namespace dem::rig {

/// The plate pressure-sinkage test of thesis chapter 4 (table 4.1: ground, bottom box, top box, lid, plate; four
/// prismatic joints; four linear actuators) with grains of a Model, which has the thesis's laws and surface::Box among
/// its Surfaces. All plates are pressed into copies of one levelled bed, which keep its contact histories.
///
///     dem::rig::plate_sinkage::Settings settings;
///     settings.size = "smoke";
///     dem::rig::PlateSinkage<Sand> test(settings, [](double h) { return dem::shape::cube8(h); });
///     const auto bed = test.make_bed();
///     const auto plate = test.press(bed, 0.03);
///     plate.fit->curve.modulus;    // k, Pa/m^n
///
/// Stages are stopped by throwing, as those of DirectShear.
template <class M>
class PlateSinkage {
 public:
  using Model = M;
  using Settings = plate_sinkage::Settings;
  using Shape = typename Model::Shape;

  /// `shape_of(half_edge)` makes the shape of the grains (m). Throws Error for settings that make no sense.
  template <class ShapeOf>
  PlateSinkage(Settings settings, ShapeOf&& shape_of) : PlateSinkage(resolved(std::move(settings)), shape_of, 0) {}

  [[nodiscard]] const Settings& settings() const { return settings_; }
  [[nodiscard]] const Shape& shape() const { return shape_; }

  /// The levelled bed, of these grains, by default rained ones.
  [[nodiscard]] Bed<Model> make_bed(const soil::Packing& start, Stages& stages) const {
    return rig::make_bed<Model>(settings_.bed, settings_.grains, shape_, true, start, stages);
  }
  [[nodiscard]] Bed<Model> make_bed() const {
    Stages quiet;
    return make_bed(bed_grains(settings_.bed, settings_.grains, shape_.volume(), shape_.bounding_radius()), quiet);
  }

  /// Presses a plate of a width (m) into a copy of the bed, and evaluates what it carries.
  [[nodiscard]] plate_sinkage::PlateResult press(const Bed<Model>& bed, double width) const {
    Stages quiet;
    plate_sinkage::PlateResult result{.width = width};
    press(bed, result, quiet, [](const auto&, double) {});
    plate_sinkage::evaluate(result, settings_);
    return result;
  }

  /// The same of a plate of result.width, with stages that are told, and look(world, travel) after each sample.
  /// `result` is filled as the test goes; its samples are not evaluated.
  template <class Look>
  void press(Bed<Model> bed, plate_sinkage::PlateResult& result, Stages& stages, Look&& look) const {
    const Settings& s = settings_;
    auto& world = bed.world;
    auto& m = world.machine();
    double top = bed.level;  // grains that stand out of the level are not to be in the plate
    for (const auto p : world.grains()) top = std::max(top, world.position(p).z() + shape_.bounding_radius());
    const Vec3 edges(s.length, result.width, s.thickness), at(0.0, 0.0, top + 0.5 * s.thickness);
    const double mass = s.plate_density * edges.prod(), k = s.drive_stiffness, c = 2.0 * std::sqrt(k * mass);
    const double interval = s.sample_interval();
    const BodyId plate = m.add_body(mbd::box_body("plate", edges, s.plate_density).at(at));
    world.set_contact("grain", "plate", grain_contact<Model>(s.grains, s.plate_friction));
    world.add_surface(plate, surface::Box(edges), {.material = "plate", .name = "plate"});
    const JointId slide = m.add_joint(mbd::prismatic("plate slide", bed.top, plate, at, Vec3::UnitZ()));
    const ActuatorId drive = m.add_actuator(mbd::joint_actuator("plate drive", slide, k, c));
    const SensorId grains = m.add_sensor(mbd::contact_sensor("grains on the plate", plate, interval));
    const SensorId driven = m.add_sensor(mbd::actuator_sensor("drive of the plate", drive, interval));

    stages.begin(text("press {:.0f} mm", 1e3 * result.width), s.sinkage);
    plate_sinkage::Pressing n{.start = world.time()};
    const double area = s.length * result.width, farthest = top - bed.level + s.sinkage + 4.0 * s.grains.edge();
    const auto push = [&] { m.set_target(drive, smooth_start(-s.speed, s.ramp_time, n.start)); };
    if (const auto stage = stages.enter(world, n, push)) {
      while (!(n.travel - n.zero >= s.sinkage)) {
        run(world, interval);
        const double travel = n.travel = -m.coordinate(slide);
        const double force = m.sensor(grains).mean().force.z, pressure = force / area;
        result.samples.push_back(
            {world.time() - n.start, travel, not_known, pressure, force, -m.sensor(driven).mean().force.x});
        if (std::isnan(n.zero) && pressure >= s.threshold) n.zero = travel;
        // A single push may pass the threshold long before the smoothed pressure does, by which sinkage is counted.
        if (travel - n.zero >= s.sinkage) {
          n.zero = plate_sinkage::zero_of(result, plate_sinkage::curve_of(result, s));
        }
        look(std::as_const(world), travel);
        stages.update(std::isnan(n.zero) ? 0.0 : travel - n.zero, text("{:.1f} kPa", 1e-3 * pressure));
        use_free_threads(world, stages);
        if (travel > farthest) {
          throw Stopped(
              text("the plate of {:g} mm is {:g} mm down and has no sinkage of {:g} mm yet: the bed hardly "
                   "carries it; lower --threshold or --sinkage",
                   1e3 * result.width, 1e3 * travel, 1e3 * s.sinkage));
        }
      }
      result.finished = true;
    }
    if (s.unload) draw_up(world, slide, drive, grains, area, result, stages);
  }

 private:
  /// Draws the plate up again until the grains push with a twentieth of what they did.
  void draw_up(typename Bed<Model>::World& world, JointId slide, ActuatorId drive, SensorId grains, double area,
               plate_sinkage::PlateResult& result, Stages& stages) const {
    const Settings& s = settings_;
    auto& m = world.machine();
    stages.begin(text("draw up {:.0f} mm", 1e3 * result.width), 1.0);
    plate_sinkage::Pressing n{.start = world.time(), .zero = -m.coordinate(slide)};
    const double first = result.samples.back().pressure;
    const auto stage = stages.enter(
        world, n, [&] { m.set_target(drive, smooth_start(s.unload_speed, s.ramp_time, n.start, -n.zero)); });
    if (!stage) return;
    double pressure = result.unloading.empty() ? first : result.unloading.back().pressure;
    while (pressure > 0.05 * first && n.travel > -0.25 * s.sinkage) {
      run(world, s.sample_interval());
      n.travel = -m.coordinate(slide) - n.zero;
      pressure = m.sensor(grains).mean().force.z / area;
      result.unloading.push_back({n.zero + n.travel, pressure});
      stages.update(std::clamp(1.0 - pressure / first, 0.0, 1.0), text("{:.1f} kPa", 1e-3 * pressure));
    }
  }

  template <class ShapeOf>
  PlateSinkage(Settings settings, ShapeOf&& shape_of, int)
      : settings_(std::move(settings)), shape_(shape_of(settings_.grains.half_edge)) {}
  static Settings resolved(Settings s) {
    plate_sinkage::resolve(s);
    return s;
  }

  Settings settings_;
  Shape shape_;
};

}  // namespace dem::rig
