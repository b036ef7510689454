#pragma once

#include <dem/rig/soft_lane/results.hpp>
#include <dem/vehicle/lane_driver.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dem::rig::soft_lane {

/// Drives a scene: along the lane, or by a table of inputs, or brakes or coasts after half of the path, or turns
/// after the first 15 % of it. Asked
/// every hundredth of a second.
class Driver {
 public:
  /// `force` (N) is what it takes to stand on the slope.
  Driver(const Settings& s, double force)
      : settings_(s),
        lane_(s.car,
              {.speed = s.speed,
               .acceleration = s.acceleration,
               .spin_limit = s.spin_limit,
               .interval = interval,
               .from = Vec3(-s.length(), 0, 0),
               .to = Vec3(s.ground_end() + 20.0, 0, 0)},
              force) {}

  /// `time` (s) and `way` (m) since the start.
  vehicle::Controls operator()(const mbd::Mechanism& m, const vehicle::Vehicle& v, double time, double way) {
    const Settings& s = settings_;
    const bool is_beyond = way >= 0.5 * s.path;
    if (!s.open_loop.empty()) return lane_.eased(s.open_loop(time), vehicle::speed_of(m, v));
    if (is_beyond && s.scene == "brake") has_braked_ = true;
    if (has_braked_) return {.brake = 1.0};
    if (is_beyond && s.scene == "coast") return {};
    if (s.scene == "drawbar") return vehicle::turn_rims(lane_.steer(m, v), held_rims(s, time));
    if (s.scene != "turn") return lane_(m, v, time);
    vehicle::Controls c = lane_.pedals(m, v, time);
    c.steer = way > 0.15 * s.path ? s.steer_deg * std::numbers::pi / 180.0 : 0.0;
    return c;
  }
  template <class V>
  void fields(V& v) {
    vehicle::OpenLoop inputs = settings_.open_loop;
    v("lane", lane_), v("has_braked", has_braked_), v("inputs", inputs);
  }

 private:
  const Settings& settings_;
  vehicle::LaneDriver lane_;
  bool has_braked_ = false;
};

/// Sees how a run ends. Asked after every sample.
class Judge {
 public:
  explicit Judge(const Settings& s) : settings_(s) {}

  /// One of `ending`, or an empty text while the run goes on. A wheel whose middle is below the lane's level has dug
  /// in. `back` (m, along x) is where a lane that goes along begins.
  std::string operator()(const Sample& x, const std::array<Vec3, 4>& wheels, double back = -HUGE_VAL) {
    const Settings& s = settings_;
    const double far = std::numbers::pi / 3.0;
    if (std::abs(x.car.roll) > far || std::abs(x.car.pitch) > far) return ending::rolled_over;
    for (std::size_t k = 0; k < 4; ++k) {
      const double middle = s.is_bed() ? 0.0 : (k % 2 == 0 ? 0.5 : -0.5) * s.car.track();
      if (std::abs(wheels[k].y() - middle) > 0.5 * s.bed.width) return ending::left_lane;
      if (x.wheels[k].sinkage + x.wheels[k].deflection > s.car.tyre.radius) return ending::dug_in;
    }
    if (s.scene == "drawbar") return x.car.time >= held_time(s) ? ending::held : "";
    if (x.way < -0.3 || std::min(wheels[2].x(), wheels[3].x()) - s.car.tyre.radius < back) return ending::slid_back;
    // From half of the path on, where it brakes or coasts, a car that stands has stopped, and one may rock as it
    // stands.
    const bool slows = (s.scene == "brake" || s.scene == "coast") && x.way >= 0.5 * s.path;
    const bool drives = !slows && x.car.controls.throttle > 0.0;
    const bool slips =
        drives && x.mean(&WheelSample::slip) > 0.8 && x.car.speed < (s.open_loop.empty() ? 0.1 * s.speed : 0.1);
    slips_since_ = !slips ? -1.0 : slips_since_ < 0.0 ? x.car.time : slips_since_;
    if (slips && x.car.time - slips_since_ >= 1.0) return ending::dug_in;
    if (x.way > furthest_ + 0.1) furthest_ = x.way, moved_at_ = x.car.time;
    if (!slows && !drives) moved_at_ = x.car.time;  // it stands because it is let stand
    if (slows && x.car.time - moved_at_ >= 2.0) return ending::stopped;
    if (x.mean(&WheelSample::slip) > 0.2 && x.car.time - moved_at_ >= 3.0) return ending::dug_in;
    stands_since_ = !(slows && std::abs(x.car.speed) < 0.02) ? -1.0 : stands_since_ < 0.0 ? x.car.time : stands_since_;
    if (stands_since_ >= 0.0 && x.car.time - stands_since_ >= 0.2) return ending::stopped;
    if (x.way >= s.path) return ending::arrived;
    if (!s.open_loop.empty()) return x.car.time >= s.open_loop.end() ? ending::inputs_ended : "";
    if (x.car.time > 4.0 * s.path / s.speed + 3.0) return ending::too_slow;
    return {};
  }
  template <class V>
  void fields(V& v) {
    v("slips_since", slips_since_, "s"), v("stands_since", stands_since_, "s");
    v("furthest", furthest_, "m"), v("moved_at", moved_at_, "s");
  }

 private:
  const Settings& settings_;
  double slips_since_ = -1.0, stands_since_ = -1.0;  // s
  double furthest_ = 0.0, moved_at_ = 0.0;           // m, s: where it last gained a tenth of a metre
};

/// A drive: since when and from where, how far it has come, and who drives and judges.
struct Driving {
  Driver driver;
  Judge judge;
  double start, from, way = 0.0;  ///< s, m, m
  double computed = 0.0;          ///< s of wall time
  double work = 0.0;              ///< J, of the engine at the start

  /// `weight` (N) of the car.
  Driving(const Settings& s, double weight, double start_, double from_, double work_)
      : driver(s, s.scene == "slope" ? std::sin(s.slope_angle()) * weight : 0.0),
        judge(s),
        start(start_),
        from(from_),
        work(work_) {}
  template <class V>
  void fields(V& v) {
    v("driver", driver), v("judge", judge), v("start", start, "s"), v("from", from, "m"), v("way", way, "m"),
        v("computed", computed, "s"), v("work", work, "J");
  }
};

}  // namespace dem::rig::soft_lane
