#pragma once

#include <dem/report/replay_recorder.hpp>
#include <dem/rig/bed/surface_profile.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/soft_lane/settings.hpp>
#include <dem/vehicle/ending.hpp>
#include <dem/vehicle/telemetry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace dem::rig::soft_lane {

using vehicle::WheelSample;

inline constexpr double interval = 0.01;  ///< s, of samples and of the driver

/// A row of telemetry. The time is that since the driver was told to go.
struct Sample {
  vehicle::CarSample car;
  double way = 0.0;                ///< m, along the lane, since the start
  double acceleration = 0.0;       ///< m/s^2, change of the car's speed since the row before
  double cost_of_transport = 0.0;  ///< work of the engine so far, for a metre of way and the weight; 0 before 0.1 m
  double hitch = 0.0;              ///< N, on the load cell of a drawbar, backwards on the car
  double widest_joint = 0.0;       ///< m, how far a joint is open
  double overlap = 0.0;            ///< the deepest of all grains, as a share of their edge
  double asleep = 0.0;             ///< share of the grains
  std::array<WheelSample, 4> wheels = {};
  std::array<vehicle::SuspensionSample, 4> suspension = {};

  [[nodiscard]] double mean(double WheelSample::*value) const { return vehicle::mean_of(wheels, value); }
  [[nodiscard]] std::vector<std::string> columns() const {
    std::vector<std::string> names;
    vehicle::add_columns(names, car);
    names.insert(names.end(), {"way_m", "acceleration_m_per_s2", "cost_of_transport", "hitch_N", "widest_joint_m",
                               "deepest_overlap_of_edge", "asleep"});
    vehicle::add_corner_columns(names);
    return names;
  }
  [[nodiscard]] std::vector<double> row() const {
    std::vector<double> row;
    vehicle::add_values(row, car);
    row.insert(row.end(), {way, acceleration, cost_of_transport, hitch, widest_joint, overlap, asleep});
    vehicle::add_corner_values(row, wheels, suspension);
    return row;
  }
  template <class V>
  void fields(V& v) {
    v("car", car), v("way", way, "m"), v("acceleration", acceleration, "m/s^2");
    v("cost_of_transport", cost_of_transport), v("hitch", hitch, "N");
    v("widest_joint", widest_joint, "m"), v("overlap", overlap), v("asleep", asleep), v.reals("wheels", wheels);
    v("suspension", suspension);
  }
};

namespace ending = vehicle::ending;

/// Means over a part of the way.
struct Means {
  double from_way = not_known, to_way = not_known;  ///< m
  double speed = not_known, slip = not_known;
  double sinkage = not_known;            ///< m, of the four wheels
  double load = not_known;               ///< N, of all four
  double torque = not_known;             ///< N m, of all four
  double pull = not_known;               ///< N, of all four, net
  double resistance = not_known;         ///< N, sum of torque/r - pull: what the soil takes of the thrust
  double energy_per_metre = not_known;   ///< J/m, of the engine
  double cost_of_transport = not_known;  ///< energy per metre and weight
  double power = not_known;              ///< W, of the engine
};

// On a drawbar the rims turn with the wanted speed, and a sled behind the car goes ever slower: slip rises evenly from
// -0.05 to 0.95 over as much time as the path has room for.

inline constexpr double held_start = 1.0;  ///< s, in which rims and sled get their speed

/// s, of a drawbar, start included. The mean of 1 - slip is 0.55; a fiftieth of the path is left.
inline double held_time(const Settings& s) { return held_start + (0.98 * s.path / s.speed - 0.5 * held_start) / 0.55; }
inline double held_slip(const Settings& s, double time) {
  return std::clamp(-0.05 + (time - held_start) / (held_time(s) - held_start), -0.05, 0.95);
}
inline double held_rims(const Settings& s, double time) { return s.speed * std::min(1.0, time / held_start); }

/// What a car on a load cell showed, on the mean over a tenth of slip.
struct PullPoint {
  double slip = 0.0;              ///< of the mean speeds of rims and car
  double pull = 0.0;              ///< N, on the load cell
  double torque = 0.0;            ///< N m, of all four wheels
  double sinkage = 0.0;           ///< m
  double efficiency = not_known;  ///< pull times way, of torque times turns
};

/// What one of several passes came to.
struct Pass {
  Means means = {};
  std::array<double, 2> rut_depth = {not_known, not_known};  ///< m, left and right, from before the first pass
  double way = 0.0;                                          ///< m
  std::string ended;
  template <class V>
  void fields(V& v) {
    v.reals("means", means), v("rut_depth", rut_depth, "m"), v("way", way, "m"), v("ended", ended);
  }
};

/// Mean height (m) of the surface over some half a metre of each track and half a tyre's width: of balls of the grains'
/// volume, seen from above. Not known where no grain is.
struct LanePlace {
  double x = 0.0;                                    ///< m
  std::array<double, 2> z = {not_known, not_known};  ///< m, left and right
};

/// Everything that a run finds. With several passes it is that of the last, but for `passes`.
struct Campaign {
  double level = not_known;  ///< m, of the lane's surface
  double solid_fraction = not_known;
  std::size_t grains = 0;
  double time_step = not_known;  ///< s
  int substeps = 0;
  bool has_stood = false;     ///< it was looked at while the car stood
  double weight = not_known;  ///< N, of the car
  std::array<double, 4> rest_sinkage = {0, 0, 0, 0}, rest_load = {0, 0, 0, 0};  ///< m, N: on its brakes, on the level
  double held_way = 0.0;                   ///< m, that the car moved on its brakes while gravity was tilted
  MeanAndDeviation overlap = {};           ///< of contacts under the tyres at rest, as a share of a grain's edge
  double deep_share = not_known;           ///< of these contacts: deeper than 2 % of the edge
  std::vector<Pass> passes;                ///< of those that came to an end
  std::vector<soil::Placement> lane;       ///< where the pass before left the grains
  std::vector<soil::Placement> untouched;  ///< where they were before the first
  std::vector<Sample> samples;
  std::string ended;                            ///< one of `ending`
  double computing = not_known;                 ///< s of wall time for a second of driving
  double lost = 0.0;                            ///< grains that left the lane
  std::array<SurfaceProfile, 2> before, after;  ///< left and right track: before the car came, behind its wheels
  std::vector<Vec3> section;                    ///< m, grains within a grain's edge of the left wheels' plane
  std::array<double, 2> ends = {0, 0};          ///< m, along x, of the lane at the end
  std::vector<LanePlace> along;                 ///< the tracks of a lane that goes along, all that was driven over
  std::array<double, 2> untouched_along = {not_known, not_known};  ///< m, left and right: the same of untouched tiles
  std::uint64_t tiles_laid = 0;                                    ///< ahead, while the car drove
  double strays = 0.0;                ///< grains that had rolled to where a tile came, and were taken out
  std::array<Vec3, 4> wheel_at = {};  ///< m, middles of the wheels at the end
  std::optional<report::Replay> replay = {};

  // Of the samples, by evaluate()
  /// Over the second half of the way, which may be one back; where the car brakes or coasts from half of the path on,
  /// over the quarter of the path before.
  Means means = {};
  /// Where the ground changes: with all wheels on the first ground, with the front wheels on the other one, with all.
  std::array<Means, 3> stretches = {};
  std::vector<PullPoint> pulls;                              ///< of a drawbar
  std::array<double, 2> rut_depth = {not_known, not_known};  ///< m, left and right, mean over half the tyre's width
  double rut_width = not_known;                              ///< m, wider than half as deep
  double drift = not_known;                                  ///< m, to the left, at the end
  double brake_way = not_known, deceleration = not_known;    ///< m, m/s^2: of braking and coasting
  double radius = not_known, ackermann = not_known;          ///< m, of a turn: as driven, as the wheels point
  double deepest = not_known;                                ///< overlap, as a share of a grain's edge

  /// Before the next pass.
  void forget_drive() {
    samples.clear(), ended.clear(), has_stood = false, section.clear(), along.clear();
    before = after = {};
    forget_evaluation();
  }
  void forget_evaluation() {
    means = {}, stretches = {}, rut_depth = {not_known, not_known}, rut_width = not_known, drift = not_known;
    brake_way = deceleration = radius = ackermann = deepest = not_known;
    pulls.clear();
  }

  /// What a run that goes on takes over.
  template <class V>
  void fields(V& v) {
    v("level", level, "m"), v("grains", grains), v("has_stood", has_stood), v("time_step", time_step, "s"),
        v("substeps", substeps), v("weight", weight, "N"), v("rest_sinkage", rest_sinkage, "m");
    v("rest_load", rest_load, "N"), v("held_way", held_way, "m"), v("overlap", overlap), v("deep_share", deep_share);
    v("samples", samples), v("ended", ended), v("computing", computing);
    v("passes", passes), v("lane", lane), v("untouched", untouched);
  }
};

/// Means over the samples from one way on to another (m; not_known: to the end); not known for less than three.
inline Means means_between(const Campaign& c, double radius, double from, double to) {
  Means m = {.from_way = from, .to_way = to};
  double n = 0.0, work = 0.0, energy = 0.0, begin = 0.0, way = 0.0, end = 0.0, end_way = 0.0;
  m.speed = m.slip = m.sinkage = m.load = m.torque = m.pull = 0.0;
  for (std::size_t k = 1; k < c.samples.size(); ++k) {
    const Sample& x = c.samples[k];
    if (!(x.way >= from) || x.way >= to) continue;
    if (n == 0.0) begin = x.car.time, way = x.way, work = x.car.engine_work;
    n += 1.0;
    m.speed += x.car.speed, m.slip += x.mean(&WheelSample::slip), m.sinkage += x.mean(&WheelSample::sinkage);
    m.load += 4.0 * x.mean(&WheelSample::load), m.torque += 4.0 * x.mean(&WheelSample::torque);
    m.pull += 4.0 * x.mean(&WheelSample::pull);
    energy = x.car.engine_work - work;
    end = x.car.time, end_way = x.way;
  }
  if (!(n > 2.0)) return {.from_way = from, .to_way = to};
  for (double* mean : {&m.speed, &m.slip, &m.sinkage, &m.load, &m.torque, &m.pull}) *mean /= n;
  m.resistance = m.torque / radius - m.pull;
  if (end > begin) m.power = energy / (end - begin);
  if (end_way > way + 0.05) m.energy_per_metre = energy / (end_way - way);
  m.cost_of_transport = m.energy_per_metre / c.weight;
  return m;
}

/// Radius of a turn over the part of the way of the means: as driven, and by the angle of the wheels.
inline void evaluate_turn(Campaign& c, double wheelbase) {
  double n = 0.0, steer = 0.0, yaw = 0.0, speed = 0.0;
  for (const Sample& x : c.samples) {
    if (!(x.way >= c.means.from_way) || x.way >= c.means.to_way) continue;
    n += 1.0, speed += x.car.speed, steer += x.car.steer, yaw += x.car.yaw_rate;
  }
  if (n < 3.0 || yaw == 0.0) return;
  c.radius = speed / yaw;
  c.ackermann = wheelbase / std::tan(steer / n);
}

/// Means of what the load cell saw over each tenth of the slip that was asked for; the slip is that of the mean speeds.
inline void evaluate_pulls(Campaign& c, const Settings& s) {
  for (double low = -0.15; low < 0.9; low += 0.1) {
    PullPoint p;
    double n = 0.0, work = 0.0, spent = 0.0, way = 0.0, rims = 0.0;
    for (const Sample& x : c.samples) {
      const double slip = held_slip(s, x.car.time);
      if (x.car.time < held_start || slip < low || slip >= low + 0.1) continue;
      n += 1.0;
      way += x.car.speed, rims += s.car.tyre.radius * x.mean(&WheelSample::spin);
      p.pull += x.hitch, p.torque += 4.0 * x.mean(&WheelSample::torque), p.sinkage += x.mean(&WheelSample::sinkage);
      work += x.hitch * x.car.speed;
      for (const WheelSample& w : x.wheels) spent += w.torque * w.spin;
    }
    if (n < 5.0) continue;
    for (double* mean : {&p.pull, &p.torque, &p.sinkage}) *mean /= n;
    p.slip = vehicle::slip_of(rims, way);
    if (spent > 0.0) p.efficiency = work / spent;
    c.pulls.push_back(p);
  }
}

/// Fills in what follows from the samples.
inline void evaluate(Campaign& c, const Settings& s) {
  const double radius = s.car.tyre.radius;
  c.forget_evaluation();
  for (std::size_t k = 0; k < 2; ++k) {
    const Rut rut = rut_between(c.before[k], c.after[k], (k == 0 ? 0.5 : -0.5) * s.car.track(), s.car.tyre.width);
    c.rut_depth[k] = rut.depth;
    if (k == 0 && rut.width > 0.0) c.rut_width = rut.width;
  }
  if (c.samples.size() < 3) return;
  c.deepest = 0.0;
  for (const Sample& x : c.samples) c.deepest = std::max(c.deepest, x.overlap);
  const Sample& last = c.samples.back();
  c.drift = last.car.position.y() - c.samples.front().car.position.y();

  const bool slows = s.scene == "brake" || s.scene == "coast";
  c.means = slows            ? means_between(c, radius, 0.25 * s.path, 0.5 * s.path)
            : last.way < 0.0 ? means_between(c, radius, -HUGE_VAL, 0.5 * last.way)
                             : means_between(c, radius, 0.5 * last.way, not_known);
  if (s.has_border()) {
    const double half = 0.5 * s.border, rear = s.border + s.car.wheelbase();
    c.stretches = {means_between(c, radius, half, s.border), means_between(c, radius, s.border, rear),
                   means_between(c, radius, rear, not_known)};
  }
  if (s.scene == "drawbar") evaluate_pulls(c, s);
  if (s.scene == "turn") evaluate_turn(c, s.car.wheelbase());
  if (!slows) return;
  // From where the driver brakes, or lets go, to a tenth of that speed.
  const Sample *first = nullptr, *end = nullptr;
  for (const Sample& x : c.samples) {
    const bool lets_go = x.way >= 0.5 * s.path && x.car.controls.throttle == 0.0;
    if (lets_go && first == nullptr) first = &x;
    if (first != nullptr && end == nullptr && x.car.speed <= 0.1 * first->car.speed) end = &x;
  }
  if (first == nullptr || first == &last) return;
  if (end == nullptr) end = &last;
  c.brake_way = end->way - first->way;
  c.deceleration = (first->car.speed - end->car.speed) / (end->car.time - first->car.time);
}

}  // namespace dem::rig::soft_lane
