#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/mbd/drive/curve.hpp>

#include <cmath>
#include <dem/core/function.hpp>
#include <numbers>
#include <utility>

namespace dem::mbd {

/// A function of time with its rate: the set point of an actuator, a prescribed motion, the size of a load. A number
/// converts to a constant signal. It may be called after grains were moved: who wants to know of grains asks between
/// steps.
///
///     Signal::ramp(0.0, 0.01, 1.0)              // 0 until t = 1 s, then grows by 0.01 a second
///     Signal::function([](double t) { return std::sin(t); })
class Signal {
 public:
  struct Sample {
    double value = 0.0;
    double rate = 0.0;  ///< per second
  };

  Signal() = default;
  /// Throws Error unless the number is finite, as do the functions below; what a function gives is seen by the run.
  Signal(double constant) : sample_{finite(constant, "value of a constant signal"), 0.0} {}  // NOLINT: see above

  /// `from` until time t0 (s), then grows by `rate` per second, until t1 if that is given.
  static Signal ramp(double from, double rate, double t0 = 0.0, double t1 = 1e300);

  /// offset + amplitude sin(2 pi frequency t + phase); frequency in Hz, phase in rad.
  static Signal sine(double amplitude, double frequency, double phase = 0.0, double offset = 0.0);

  /// From one value to another between t0 and t1 (s), without a jump in rate or acceleration: 10 s^3 - 15 s^4 + 6 s^5.
  static Signal smooth_step(double from, double to, double t0, double t1);

  /// Straight lines between (time, value) points; the first value before the first time, the last one after the last.
  static Signal table(Curve curve);

  /// Any function of time. A rate that is not given is the mean one over the machine's time step, from half a step
  /// before t to half a step after: good to dt^2 where the function is smooth. The rates of all steps sum up to the
  /// rise of the function. So a jump of the set point gives the whole impulse of a damper, c times the jump, whatever
  /// the time step is.
  static Signal function(Function<double(double)> value);
  static Signal function(Function<double(double)> value, Function<double(double)> rate);
  /// A value that stays, with a rate that is given: for set points that come from outside every step. A fixed body that
  /// prescribed_position moves by held(0, v) is a belt: it stays, and its surfaces run at v (m/s). What
  /// Mechanism::set_motion(id, value, rate) sets holds at the end of the next step, and its sub-steps go there by and
  /// by.
  static Signal held(double value, double rate);

  /// A signal whose rate is this one's value; its own value is 0.
  Signal as_rate() const {
    return Signal([value = *this](double t, double dt) -> Sample { return {0.0, value(t, dt).value}; });
  }

  /// Whether it is a number, which stays until another signal is given.
  bool is_constant() const { return !function_ && sample_.rate == 0.0; }

  /// At a time (s) of a machine that takes steps of dt (s; 0: not known).
  Sample operator()(double time, double dt = 0.0) const { return function_ ? function_(time, dt) : sample_; }

  template <class V>
  void fields(V& v) {
    v.given("is_a_function", static_cast<bool>(function_));
    v("value", sample_.value), v("rate", sample_.rate);
  }

 private:
  static double finite(double x, const char* what);
  explicit Signal(Function<Sample(double, double)> f) : function_(std::move(f)) {}

  Sample sample_;
  Function<Sample(double, double)> function_;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE Signal Signal::ramp(double from, double rate, double t0, double t1) {
  for (const double x : {from, rate, t0, t1}) finite(x, "value, rate or time of a ramp");
  if (!(t1 >= t0)) fail("a ramp ends at {:g} s, but must not end before its start, {:g} s", t1, t0);
  return Signal([=](double t, double) -> Sample {
    if (t < t0) return {from, 0.0};
    if (t > t1) return {from + rate * (t1 - t0), 0.0};
    return {from + rate * (t - t0), rate};
  });
}

DEM_INLINE Signal Signal::sine(double amplitude, double frequency, double phase, double offset) {
  for (const double x : {amplitude, frequency, phase, offset}) finite(x, "constant of a sine");
  const double omega = 2.0 * std::numbers::pi * frequency;
  return Signal([=](double t, double) -> Sample {
    return {offset + amplitude * std::sin(omega * t + phase), amplitude * omega * std::cos(omega * t + phase)};
  });
}

DEM_INLINE Signal Signal::smooth_step(double from, double to, double t0, double t1) {
  for (const double x : {from, to, t0, t1}) finite(x, "value or time of a smooth step");
  if (!(t1 > t0)) fail("smooth_step ends at {:g} s, but must end after its start, {:g} s", t1, t0);
  return Signal([=](double t, double) -> Sample {
    if (t <= t0) return {from, 0.0};
    if (t >= t1) return {to, 0.0};
    const double s = (t - t0) / (t1 - t0);
    return {from + (to - from) * s * s * s * (10.0 - s * (15.0 - 6.0 * s)),
            (to - from) * 30.0 * s * s * (1.0 - s) * (1.0 - s) / (t1 - t0)};
  });
}

DEM_INLINE Signal Signal::table(Curve curve) {
  if (curve.empty()) fail("a table of a signal has no points, but needs at least 2; give it (time, value) pairs");
  return Signal([curve = curve.held_outside()](double t, double) -> Sample { return {curve(t), curve.slope(t)}; });
}

DEM_INLINE Signal Signal::function(Function<double(double)> value) {
  return Signal([value = std::move(value)](double t, double dt) -> Sample {
    const double h = dt > 0.0 ? 0.5 * dt : 1e-6;
    return {value(t), (value(t + h) - value(t - h)) / (2.0 * h)};
  });
}

DEM_INLINE Signal Signal::function(Function<double(double)> value, Function<double(double)> rate) {
  return Signal([value = std::move(value), rate = std::move(rate)](double t, double) -> Sample {
    return {value(t), rate(t)};
  });
}

DEM_INLINE Signal Signal::held(double value, double rate) {
  Signal s(value);
  s.sample_.rate = finite(rate, "rate of a signal");
  return s;
}

DEM_INLINE double Signal::finite(double x, const char* what) {
  if (!std::isfinite(x)) fail("a {} is {:g}, but must be finite", what, x);
  return x;
}

}  // namespace dem::mbd

#endif
