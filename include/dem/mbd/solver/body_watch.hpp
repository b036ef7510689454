#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/mbd/ids.hpp>

namespace dem::mbd {

/// Notes the first body that blows up: that is too fast, or has anything in its motion that is not a number.
class BodyWatch {
 public:
  /// Looks at a body's motion at `time` (s). `largest_speed` is in m/s, and in rad/s for its spin.
  void look(BodyId id, const Body& body, double largest_speed, double time);
  bool seen() const { return body_.valid(); }
  BodyId body() const { return body_; }  ///< no valid id if all are well
  double time() const { return time_; }  ///< s, when it was seen

  template <class V>
  void fields(V& v) {
    v("bad_body", body_), v("bad_time", time_, "s");
  }

 private:
  /// Each sum of squares is compared by itself: a maximum of several would drop a NaN in one of them.
  static bool is_well(const integrator::Motion<double>& motion, double largest_speed);

  BodyId body_;
  double time_ = 0.0;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void BodyWatch::look(BodyId id, const Body& body, double largest_speed, double time) {
  if (is_well(body.motion, largest_speed) || seen()) [[likely]]
    return;
  body_ = id;
  time_ = time;
}

DEM_INLINE bool BodyWatch::is_well(const integrator::Motion<double>& motion, double largest_speed) {
  const double limit = largest_speed * largest_speed, anywhere = 1e300;
  const Matrix3<double>& r = motion.rotation;
  const double turned = dot(r.row0, r.row0) + dot(r.row1, r.row1) + dot(r.row2, r.row2);
  return dot(motion.velocity, motion.velocity) < limit &&
         dot(motion.angular_velocity, motion.angular_velocity) < limit &&
         dot(motion.position, motion.position) < anywhere && turned < anywhere;
}

}  // namespace dem::mbd

#endif
