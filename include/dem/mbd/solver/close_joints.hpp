#pragma once

// How the sub-steps of a machine are chosen, by how far its joints may open. A derived stiffness grows as the square of
// the number of sub-steps, so an opening falls with its square.
//
// Before the first step of a world: the joints' stiffness has to carry the weight of all bodies that they are joined
// with. While a world or a machine alone is running: where a joint opens by more than half of what is allowed, the
// sub-steps are raised so far that the same load opens it by a quarter of it. They are never lowered. All this depends
// on nothing but the state of the machine.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/joint_watch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dem::mbd {

/// The number of sub-steps that lowers an opening from `share` of what is allowed to `wanted`, from n of them; at most
/// `most`, but never less than n.
int substeps_for(int n, double share, double wanted, int most);

/// The watched joint that weight opens farthest, as a share of what is allowed and of gravity (s^2/m), if each carries
/// all bodies that it is joined with.
struct MostLoaded {
  JointId joint = {};
  double share = 0.0;
};
MostLoaded most_loaded(const Parts& m, const JointWatch& watch);

/// Brings stiffness that was raised while a machine runs in by and by. A strained spring that gets stiffer all at once
/// gains energy; here it grows at most fourfold in a step, under the dampers that belong to its end.
class StiffnessRamp {
 public:
  /// What the stiffness is now, before it is derived anew.
  static std::vector<double> stiffness_of(Parts& m);

  StiffnessRamp() = default;
  /// From `before` to what is in the parts now, which is put back to `before`.
  StiffnessRamp(Parts& m, const std::vector<double>& before);

  bool is_over() const { return to_.empty(); }
  /// How many times as stiff the softest part is going to be; 1 when it is over.
  double left() const { return is_over() ? 1.0 : left_; }

  /// To be called once in a step of the world, or of a machine alone.
  void step(Parts& m);

  template <class V>
  void fields(V& v) {
    v("to", to_), v("left", left_);
  }

 private:
  template <class F>
  static void for_each_stiffness(Parts& m, F&& each) {
    for (Joint& j : m.joints) {
      each(j.k);
      each(j.kr);
    }
    for (JointLimitState& e : m.limits) each(e.stiffness);
    for (JointFrictionState& e : m.friction) each(e.law.stiffness);
    for (Coupling& g : m.couplings) each(g.k);
  }

  std::vector<double> to_;  ///< N/m and N m/rad, in the order of for_each_stiffness
  double left_ = 1.0;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE int substeps_for(int n, double share, double wanted, int most) {
  const double needed = std::ceil(n * std::sqrt(share / wanted) * (1.0 - 1e-12));
  return std::max(n, needed < most ? static_cast<int>(needed) : most);
}

DEM_INLINE MostLoaded most_loaded(const Parts& m, const JointWatch& watch) {
  MostLoaded most;
  for (const JointWatch::Watched& w : watch.watched()) {
    const double k = m.joints[w.joint].k;
    if (k > 0.0 && w.mass / (k * w.displacement) > most.share) most = {JointId(w.joint), w.mass / (k * w.displacement)};
  }
  return most;
}

DEM_INLINE std::vector<double> StiffnessRamp::stiffness_of(Parts& m) {
  std::vector<double> all;
  for_each_stiffness(m, [&](double& k) { all.push_back(k); });
  return all;
}

DEM_INLINE StiffnessRamp::StiffnessRamp(Parts& m, const std::vector<double>& before) {
  auto was = before.begin();
  for_each_stiffness(m, [&](double& k) {
    to_.push_back(k);
    left_ = std::max(left_, *was > 0.0 ? k / *was : 1.0);
    if (*was > 0.0) k = std::min(k, *was);
    ++was;
  });
  step(m);
}

DEM_INLINE void StiffnessRamp::step(Parts& m) {
  if (is_over()) return;
  constexpr double growth = 4.0;
  auto to = to_.begin();
  double left = 1.0;
  for_each_stiffness(m, [&](double& k) {
    if (k < *to) {
      k = std::min(growth * k, *to);
      left = std::max(left, *to / k);
    }
    ++to;
  });
  left_ = left;
  if (left <= 1.0) to_.clear();
}

}  // namespace dem::mbd

#endif
