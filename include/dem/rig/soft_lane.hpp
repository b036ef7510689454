#pragma once

#include <dem/io/duration.hpp>
#include <dem/rig/bed/make_bed.hpp>
#include <dem/rig/soft_lane/driver.hpp>
#include <dem/rig/soft_lane/stand.hpp>

#include <utility>

namespace dem::rig {

/// A car that drives on grains (thesis chapter 6: the Humvee on soft soil), on grains of a Model, which has the
/// thesis's laws and surface::Box, Cylinder and TriangleMesh among its Surfaces. The car is the machine of the world;
/// its rigid tyres are surfaces of the wheels. Slopes are tilted gravity: x runs up the slope, y to the left.
///
/// A trough of grains is rained, levelled and put under each track (soft_lane/lane.hpp). Or it is a tile that repeats
/// itself, and several of them go along with the car as far as it drives (soft_lane/tile.hpp). The car hangs on a
/// crane, a damper on its chassis under which its weight sinks at the set-down speed, ever slower as the grains take it
/// up. Then it stands on its brakes while gravity is tilted, and drives.
///
///     dem::rig::soft_lane::Settings settings;
///     settings.size = "smoke";
///     dem::rig::SoftLane<Sand> test(settings, [](double h) { return dem::shape::cube8(h); });
///     auto stand = test.set_down(test.make_bed());
///     dem::rig::soft_lane::Campaign result;
///     test.drive(stand, result);
///     result.means.resistance;                          // N
template <class M>
class SoftLane {
 public:
  using Model = M;
  using Settings = soft_lane::Settings;
  using Campaign = soft_lane::Campaign;
  using Stand = soft_lane::Stand<Model>;
  using Shape = typename Model::Shape;

  /// `shape_of(half_edge)` makes the shape of the grains (m). Throws Error for settings that make no sense.
  template <class ShapeOf>
  SoftLane(Settings settings, ShapeOf&& shape_of) : SoftLane(resolved(std::move(settings)), shape_of, 0) {}

  [[nodiscard]] const Settings& settings() const { return settings_; }
  [[nodiscard]] const Shape& shape() const { return shape_; }

  /// The levelled bed of one trough.
  [[nodiscard]] Bed<Model> make_bed(const soil::Packing& start, Stages& stages) const {
    return rig::make_bed<Model>(settings_.bed, settings_.grains, shape_, false, start, stages);
  }
  [[nodiscard]] Bed<Model> make_bed() const {
    Stages quiet;
    return make_bed(bed_grains(settings_.bed, settings_.grains, shape_.volume(), shape_.bounding_radius()), quiet);
  }

  /// s, for a lane of the grains of a bed: a whole number of steps between two samples.
  [[nodiscard]] static double time_step(const Bed<Model>& bed) {
    return soft_lane::interval / std::ceil(soft_lane::interval / bed.world.time_step() * (1.0 - 1e-9));
  }
  /// m, of a lane of these grains of a bed: that of the hard ground, if there is any.
  [[nodiscard]] double level(const Bed<Model>& bed, std::span<const soil::Placement> grains) const {
    return settings_.scene == "step" ? soft_lane::level_of(settings_, grains) : bed.level;
  }
  /// Makes the lane of a bed, sets the car down on it until the crane carries less than 5 % of it for 30 ms, takes the
  /// crane off, and lets the car stand on its brakes for 0.2 s. Throws Stopped if that takes longer than twice the
  /// stage limit.
  [[nodiscard]] Stand set_down(const Bed<Model>& bed) const {
    Stages quiet;
    return set_down(bed, quiet, [](const auto&) {});
  }
  /// The same with look(stand) every ten milliseconds.
  template <class Look>
  [[nodiscard]] Stand set_down(const Bed<Model>& bed, Stages& stages, Look&& look) const {
    const auto grains = soft_lane::lane_grains(settings_, soil::placements(bed.world));
    return set_down(grains, level(bed, grains), {}, time_step(bed), stages, look);
  }
  /// The same on grains as they lie in the lane, e.g. with the ruts of an earlier pass; `level` (m) is that of the
  /// bed, and of hard ground. `before` are the grains before the first pass: if they are none, these ones are, once
  /// they have settled, and their level is that of the lane.
  template <class Look>
  [[nodiscard]] Stand set_down(std::span<const soil::Placement> grains, double level,
                               std::vector<soil::Placement> before, double dt, Stages& stages, Look&& look) const {
    const Settings& s = settings_;
    Stand stand{.world = soft_lane::make_lane<Model>(s, shape_, grains, level, dt),
                .level = level,
                .before = std::move(before)};
    if (s.scene == "step") stand.hard = soft_lane::add_hard_ground(stand.world, s, level);
    stages.begin("settle lane");
    const auto kept = stages.keep("lane", stand);
    settle(stand.world, s.grains.edge(), s.bed.stage_limit, "--stage-limit", stages, [] { return 0.0; });
    if (stand.before.empty()) {  // else it is known from the run that goes on
      stand.before = soil::placements(stand.world);
      stand.level = soft_lane::level_of(s, stand.before);
    }
    lower(stand, stages, look);
    return stand;
  }
  /// The same on tiles that go along with the car; `level` (m) is that of the tile's bed.
  template <class Look>
  [[nodiscard]] Stand set_down(const soil::Tile& tile, double level, double dt, Stages& stages, Look&& look) const {
    const Settings& s = settings_;
    const std::size_t grains = tile.grains.size() * static_cast<std::size_t>(s.tiles);
    Stand stand{.world = soft_lane::make_lane<Model>(s, shape_, {}, level, dt, grains)};
    soft_lane::lay_patch(stand, s, tile);
    const auto kept = stages.keep("lane", stand);
    lower(stand, stages, look);
    return stand;
  }

  /// Tilts gravity as the scene says while the car stands on its brakes, drives until something ends it, and evaluates
  /// what was found.
  void drive(Stand& stand, Campaign& result) const {
    Stages quiet;
    drive(stand, result, quiet, [](const auto&) {});
    soft_lane::look_back(stand, settings_, result);
    soft_lane::evaluate(result, settings_);
  }
  /// The same with look(stand) after each sample. `result` is filled as the run goes; it is not evaluated.
  template <class Look>
  void drive(Stand& stand, Campaign& result, Stages& stages, Look&& look) const {
    const Settings& s = settings_;
    auto& world = stand.world;
    const double radius = s.car.tyre.radius, steer_rate = s.steer_deg_per_s * std::numbers::pi / 180.0;
    const auto kept = stages.keep("lane", stand), kept_car = stages.keep("car", stand.car);
    vehicle::take_controls(world.machine(), stand.car);
    if (!result.has_stood) look_at_rest(stand, result);
    if (s.slope_angle() != 0.0) tilt(stand, result, stages, look);
    soft_lane::Driving n(s, result.weight, world.time(), soft_lane::place_of(stand), stand.car.driveline.engine.work);
    stages.begin("drive", s.path);
    const auto stage = stages.enter(world, n);
    const double began = io::steady_seconds() - n.computed;
    while (stage && result.ended.empty()) {
      const auto now = n.driver(world.machine(), stand.car, world.time() - n.start, n.way);
      soft_lane::pull(stand, s, world.time() - n.start);
      soft_lane::advance(stand, now, s.scene == "turn" ? steer_rate : 0.5);
      n.way = soft_lane::place_of(stand) - n.from;
      auto x = soft_lane::sample_of(stand, now, world.time() - n.start, n.way, radius);
      if (!result.samples.empty()) {
        x.acceleration = (x.car.speed - result.samples.back().car.speed) / soft_lane::interval;
      }
      if (n.way > 0.1) x.cost_of_transport = (x.car.engine_work - n.work) / (result.weight * n.way);
      result.ended = n.judge(x, soft_lane::wheels_of(stand), stand.patch ? stand.patch->back() + s.rim() : -HUGE_VAL);
      result.samples.push_back(x);
      n.computed = io::steady_seconds() - began;
      result.computing = n.computed / (world.time() - n.start);
      look(std::as_const(stand));
      stages.update(
          std::clamp(n.way, 0.0, s.path),
          text("{:.2f} m in {:.2f} s, {:.2f} m/s, slip {:.2f}, {:.0f} mm deep", n.way, x.car.time, x.car.speed,
               x.mean(&soft_lane::WheelSample::slip), 1e3 * x.mean(&soft_lane::WheelSample::sinkage)));
    }
  }

 private:
  template <class ShapeOf>
  SoftLane(Settings settings, ShapeOf&& shape_of, int)
      : settings_(std::move(settings)), shape_(shape_of(settings_.grains.half_edge)) {}
  static Settings resolved(Settings s) {
    soft_lane::resolve(s);
    return s;
  }

  /// What the car does to the lane before it drives.
  void look_at_rest(const Stand& stand, Campaign& result) const {
    result.has_stood = true;
    result.grains = stand.world.grain_count();
    result.time_step = stand.world.time_step();
    result.substeps = stand.world.machine().substeps;
    result.weight = vehicle::weight_of(stand.world.machine());
    const auto rest = soft_lane::sample_of(stand, {}, 0.0, 0.0, settings_.car.tyre.radius);
    for (std::size_t k = 0; k < 4; ++k) {
      result.rest_sinkage[k] = rest.wheels[k].sinkage;
      result.rest_load[k] = rest.wheels[k].load;
    }
    const auto overlaps = soft_lane::overlaps_under_tyres(stand, settings_);
    result.level = stand.level;
    result.overlap = mean_of(overlaps);
    result.deep_share =
        static_cast<double>(std::count_if(overlaps.begin(), overlaps.end(), [](double x) { return x > 0.02; })) /
        static_cast<double>(overlaps.size());
  }

  /// Hangs the car over the lane, lowers it until the crane carries next to nothing of it, and lets it stand on its
  /// brakes for 0.2 s.
  template <class Look>
  void lower(Stand& stand, Stages& stages, Look&& look) const {
    const Settings& s = settings_;
    soft_lane::add_car(stand, s);
    const auto kept_car = stages.keep("car", stand.car);
    auto& m = stand.world.machine();
    vehicle::take_controls(m, stand.car);
    const double weight = vehicle::weight_of(m), limit = 2.0 * s.bed.stage_limit;
    const vehicle::Controls brakes{.brake = 1.0};
    stages.begin("set down", 1.0);
    soft_lane::SettingDown n{stand.world.time()};
    const auto stage = stages.enter(stand.world, n);
    while (stage && !n.done) {
      soft_lane::advance(stand, brakes);
      look(std::as_const(stand));
      double on_grains = 0.0;
      for (std::size_t k = 0; k < 4; ++k) on_grains += soft_lane::ground_on(stand, k).force.z;
      const double crane = std::abs(m.load(stand.crane).wrench.force.z);
      n.done = n.carried(stand.world.time(), on_grains > 0.5 * weight ? crane / weight : 1.0);
      if (n.done) m.switch_on(stand.crane, false);
      stages.update(std::clamp(on_grains / weight, 0.0, 1.0),
                    text("grains carry {:.1f} of {:.1f} kN", 1e-3 * on_grains, 1e-3 * weight));
      if (!n.done && stand.world.time() - n.start > limit) {
        throw Stopped(
            text("the car is not set down after {:g} s: the grains carry {:.4g} N of {:.4g} N; raise "
                 "--stage-limit or --set-down-speed",
                 limit, on_grains, weight));
      }
    }
    while (stage && n.stood < 20) {
      soft_lane::advance(stand, brakes);
      look(std::as_const(stand));
      ++n.stood;
      stages.update(1.0, "on its brakes");
    }
  }

  /// Turns gravity to that of the slope, smoothly within half a second, and lets the car stand for 0.2 s more.
  template <class Look>
  void tilt(Stand& stand, Campaign& result, Stages& stages, Look&& look) const {
    const double whole = settings_.slope_angle(), over = 0.5;
    const bool is_side = settings_.scene == "side-slope";
    stages.begin("tilt", over + 0.2);
    soft_lane::Tilting n{stand.world.time(), soft_lane::place_of(stand)};
    const auto stage = stages.enter(stand.world, n);
    for (double t = stand.world.time() - n.start; stage && t < over + 0.2; t = stand.world.time() - n.start) {
      const double share = std::min(1.0, (t + soft_lane::interval) / over);
      const double angle = whole * share * share * (3.0 - 2.0 * share), along = -9.81 * std::sin(angle);
      stand.world.set_gravity(Vec3(is_side ? 0.0 : along, is_side ? along : 0.0, -9.81 * std::cos(angle)));
      soft_lane::advance(stand, {.brake = 1.0});
      look(std::as_const(stand));
      result.held_way = soft_lane::place_of(stand) - n.stood;
      stages.update(t);
    }
  }

  Settings settings_;
  Shape shape_;
};

}  // namespace dem::rig
