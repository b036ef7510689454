#pragma once

#include <dem/report/replay_recorder.hpp>
#include <dem/rig/bed/surface_profile.hpp>
#include <dem/rig/soft_lane/settings.hpp>
#include <dem/vehicle/ending.hpp>
#include <dem/vehicle/telemetry.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace dem::rig::soft_lane {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

using vehicle::WheelSample;

/// A row of telemetry. The time is that since the driver was told to go.
struct Sample {
  vehicle::CarSample car;
  double way = 0.0;           ///< m, along the lane, since the start
  double acceleration = 0.0;  ///< m/s^2, change of the car's speed since the row before
  double widest_joint = 0.0;  ///< m, how far a joint is open
  double overlap = 0.0;       ///< the deepest of all grains, as a share of their edge
  double asleep = 0.0;        ///< share of the grains
  std::array<WheelSample, 4> wheels = {};

  [[nodiscard]] double mean(double WheelSample::*value) const {
    return 0.25 * (wheels[0].*value + wheels[1].*value + wheels[2].*value + wheels[3].*value);
  }
  [[nodiscard]] std::vector<std::string> columns() const {
    std::vector<std::string> names;
    vehicle::add_columns(names, car);
    names.insert(names.end(),
                 {"way_m", "acceleration_m_per_s2", "widest_joint_m", "deepest_overlap_of_edge", "asleep"});
    for (std::size_t k = 0; k < 4; ++k) {
      vehicle::add_columns(names, wheels[k], std::string(vehicle::corner_letters[k]) + "_");
    }
    return names;
  }
  [[nodiscard]] std::vector<double> row() const {
    std::vector<double> row;
    vehicle::add_values(row, car);
    row.insert(row.end(), {way, acceleration, widest_joint, overlap, asleep});
    for (const WheelSample& w : wheels) vehicle::add_values(row, w);
    return row;
  }
  template <class V>
  void fields(V& v) {
    v("car", car), v("way", way, "m"), v("acceleration", acceleration, "m/s^2");
    v("widest_joint", widest_joint, "m"), v("overlap", overlap), v("asleep", asleep), v.reals("wheels", wheels);
  }
};

namespace ending = vehicle::ending;

/// Means over the second half of the way; where the car brakes or coasts from half of the path on, over the quarter of
/// the path before.
struct Means {
  double from_way = not_known;  ///< m
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

/// Everything that a run finds.
struct Campaign {
  double level = not_known;  ///< m, of the lane's surface
  double solid_fraction = not_known;
  std::size_t grains = 0;
  double time_step = not_known;  ///< s
  int substeps = 0;
  bool has_stood = false;     ///< it was looked at while the car stood
  double weight = not_known;  ///< N, of the car
  std::array<double, 4> rest_sinkage = {0, 0, 0, 0}, rest_load = {0, 0, 0, 0};  ///< m, N: on its brakes, on the level
  double held_way = 0.0;          ///< m, that the car moved on its brakes while gravity was tilted
  MeanAndDeviation overlap = {};  ///< of contacts under the tyres at rest, as a share of a grain's edge
  double deep_share = not_known;  ///< of these contacts: deeper than 2 % of the edge
  std::vector<Sample> samples;
  std::string ended;                            ///< one of `ending`
  double computing = not_known;                 ///< s of wall time for a second of driving
  double lost = 0.0;                            ///< grains that left the lane
  std::array<SurfaceProfile, 2> before, after;  ///< left and right track: before the car came, behind its wheels
  std::vector<Vec3> section;                    ///< m, grains within a grain's edge of the left wheels' plane
  std::array<Vec3, 4> wheel_at = {};            ///< m, middles of the wheels at the end
  std::optional<report::Replay> replay = {};

  // Of the samples, by evaluate()
  Means means = {};
  std::array<double, 2> rut_depth = {not_known, not_known};  ///< m, left and right, mean over half the tyre's width
  double rut_width = not_known;                              ///< m, wider than half as deep
  double drift = not_known;                                  ///< m, to the left, at the end
  double brake_way = not_known, deceleration = not_known;    ///< m, m/s^2: of braking and coasting
  double radius = not_known, ackermann = not_known;          ///< m, of a turn: as driven, as the wheels point
  double deepest = not_known;                                ///< overlap, as a share of a grain's edge

  /// What a run that goes on takes over.
  template <class V>
  void fields(V& v) {
    v("level", level, "m"), v("grains", grains), v("has_stood", has_stood), v("time_step", time_step, "s"),
        v("substeps", substeps), v("weight", weight, "N"), v("rest_sinkage", rest_sinkage, "m");
    v("rest_load", rest_load, "N"), v("held_way", held_way, "m"), v("overlap", overlap), v("deep_share", deep_share);
    v("samples", samples), v("ended", ended), v("computing", computing);
  }
};

/// Depth and width of a rut, from the surface before and after (m); `middle` is that of the track.
inline void evaluate_rut(const SurfaceProfile& before, const SurfaceProfile& after, double middle, double tyre,
                         double& depth, double& width) {
  if (before.z.size() != after.z.size() || before.z.empty()) return;
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < before.z.size(); ++k) {
    if (std::abs(before.y[k] - middle) < 0.25 * tyre) sum += before.z[k] - after.z[k], count += 1.0;
  }
  if (count == 0.0) return;
  depth = sum / count;
  width = 0.0;
  for (std::size_t k = 0; k < before.z.size(); ++k) {
    if (before.z[k] - after.z[k] > 0.5 * depth) width += before.strip();
  }
}

/// Fills in what follows from the samples.
inline void evaluate(Campaign& c, const Settings& s) {
  const double radius = s.car.tyre.radius;
  double width = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double middle = (k == 0 ? 0.5 : -0.5) * s.car.track();
    evaluate_rut(c.before[k], c.after[k], middle, s.car.tyre.width, c.rut_depth[k], width);
    if (k == 0 && width > 0.0) c.rut_width = width;
  }
  if (c.samples.size() < 3) return;
  c.deepest = 0.0;
  for (const Sample& x : c.samples) c.deepest = std::max(c.deepest, x.overlap);
  const Sample& last = c.samples.back();
  c.drift = last.car.position.y() - c.samples.front().car.position.y();

  Means m = {};
  const bool slows = s.scene == "brake" || s.scene == "coast";
  m.from_way = slows ? 0.25 * s.path : 0.5 * last.way;
  double n = 0.0, energy = 0.0;
  m.speed = m.slip = m.sinkage = m.load = m.torque = m.pull = 0.0;
  double begin = 0.0, way = 0.0, steer = 0.0, yaw = 0.0;
  for (std::size_t k = 1; k < c.samples.size(); ++k) {
    const Sample& x = c.samples[k];
    if (!(x.way >= m.from_way) || (slows && x.way >= 0.5 * s.path)) continue;
    if (n == 0.0) begin = x.car.time, way = x.way;
    n += 1.0;
    m.speed += x.car.speed, m.slip += x.mean(&WheelSample::slip), m.sinkage += x.mean(&WheelSample::sinkage);
    m.load += 4.0 * x.mean(&WheelSample::load), m.torque += 4.0 * x.mean(&WheelSample::torque);
    m.pull += 4.0 * x.mean(&WheelSample::pull);
    energy += x.car.engine_power * (x.car.time - c.samples[k - 1].car.time);
    steer += x.car.steer, yaw += x.car.yaw_rate;
    m.power = x.car.time > begin ? energy / (x.car.time - begin) : not_known;
    m.energy_per_metre = x.way > way + 0.05 ? energy / (x.way - way) : not_known;
  }
  if (n > 2.0) {
    for (double* mean : {&m.speed, &m.slip, &m.sinkage, &m.load, &m.torque, &m.pull}) *mean /= n;
    m.resistance = m.torque / radius - m.pull;
    m.cost_of_transport = m.energy_per_metre / c.weight;
    c.means = m;
    if (s.scene == "turn" && std::abs(yaw) > 0.0) {
      c.radius = m.speed * n / yaw;
      c.ackermann = s.car.wheelbase() / std::tan(steer / n);
    }
  }
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
