#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/math/wrench.hpp>
#include <dem/mbd/ids.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace dem::mbd {

/// The mean of a force and torque over the last `window` seconds, weighted by time. Samples are summed in 64 bins of a
/// ring, so that it needs no memory that grows, and no sum ever runs away: the newest part of the window is exact, its
/// oldest edge is one bin coarse.
class WindowAverage {
 public:
  explicit WindowAverage(double window = 0.0) : window_(require_non_negative(window, "averaging window", "s")) {}

  /// Adds a sample that held for dt seconds.
  void add(const Wrench& w, double dt);

  /// The newest sample.
  const Wrench& latest() const { return latest_; }

  /// The mean over the window, or over what there is of it so far. With a window of 0 it is the newest sample.
  Wrench mean() const;
  void clear() { bins_ = {}; }
  double window() const { return window_; }

  template <class V>
  void fields(V& v) {
    v.given("window", window_, "s"), v("latest", latest_), v("head", head_), v("bins", bins_);
  }

 private:
  struct Bin {
    Wrench sum;
    double time = 0.0;
    template <class V>
    void fields(V& v) {
      v("sum", sum), v("time", time, "s");
    }
  };
  static constexpr std::size_t bin_count = 64, ring_size = bin_count + 1;

  double window_;
  Wrench latest_;
  std::array<Bin, ring_size> bins_ = {};
  std::size_t head_ = 0;
};

/// What a sensor measures.
enum class SensorTarget {
  contacts,  ///< force and torque on a body from grains, surfaces of other bodies, and terrains (soil columns), about
             ///< its centre of mass, global axes
  total,     ///< force and torque on a body from everything but gravity, about its centre of mass, global axes
  joint,     ///< force and torque of a joint on its body b with its limits and friction, about the joint's point
  actuator,  ///< force (N) or, where it turns something, torque (N m) of an actuator, in force.x: see drive_effort
  drive      ///< the same of a prescribed motion's drive
};

struct SensorSpec {
  std::string name;
  SensorTarget target;
  std::size_t index;    ///< of the body, joint, actuator or prescribed motion
  double window = 0.0;  ///< s, over which the mean is taken
};

/// What a body feels of what it touches: grains, surfaces of other bodies of the machine, and terrains.
DEM_SETUP inline SensorSpec contact_sensor(std::string name, BodyId body, double window) {
  return {std::move(name), SensorTarget::contacts, body.index(), window};
}
/// All forces on a body but its weight and the forces of prescribed motions (drive_sensor).
DEM_SETUP inline SensorSpec total_force_sensor(std::string name, BodyId body, double window) {
  return {std::move(name), SensorTarget::total, body.index(), window};
}
DEM_SETUP inline SensorSpec joint_sensor(std::string name, JointId joint, double window) {
  return {std::move(name), SensorTarget::joint, joint.index(), window};
}
DEM_SETUP inline SensorSpec actuator_sensor(std::string name, ActuatorId actuator, double window) {
  return {std::move(name), SensorTarget::actuator, actuator.index(), window};
}
DEM_SETUP inline SensorSpec drive_sensor(std::string name, MotionId motion, double window) {
  return {std::move(name), SensorTarget::drive, motion.index(), window};
}

struct Sensor {
  SensorSpec spec;
  WindowAverage average;
  template <class V>
  void fields(V& v) {
    v.given("name", spec.name), v.given("target", spec.target), v.given("index", spec.index), v("average", average);
  }
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void WindowAverage::add(const Wrench& w, double dt) {
  latest_ = w;
  if (window_ <= 0.0 || dt <= 0.0) return;
  if (bins_[head_].time >= window_ / bin_count) {
    head_ = (head_ + 1) % ring_size;
    bins_[head_] = {};
  }
  bins_[head_].sum = bins_[head_].sum + dt * w;
  bins_[head_].time += dt;
}

DEM_INLINE Wrench WindowAverage::mean() const {
  Wrench sum;
  double time = 0.0;
  const double full = (1.0 - 1e-9) * window_;  // s: times that sum up to the window but for rounding fill it
  for (std::size_t k = 0; k < ring_size && time < full; ++k) {
    const Bin& bin = bins_[(head_ + ring_size - k) % ring_size];
    sum = sum + bin.sum;
    time += bin.time;
  }
  return time > 0.0 ? (1.0 / time) * sum : latest_;
}

}  // namespace dem::mbd

#endif
