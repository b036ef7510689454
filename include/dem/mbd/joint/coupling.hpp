#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/mbd/joint/coordinate.hpp>

#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// A linear constraint between joint coordinates, sum(ratio_i q_i) = value at assembly, held by a spring and a damper:
/// gears, rack and pinion, differentials. Coordinate i is driven by ratio_i * lambda: a torque about the joint's axis
/// where it turns, a force at the joint's point where it slides. It acts on b, and with the opposite sign on the body a
/// that carries the joint. So momentum is kept and housings feel the torque that they hold. Teeth are not modelled:
/// nothing presses gears apart or loads their bearings across the axis, there is no backlash and no loss.
struct CouplingSpec {
  enum class Moves { any, rotation, displacement };
  struct Term {
    JointId joint;
    double ratio;
    Dof dof = Dof::own;
    Moves needs = Moves::any;  ///< what the coordinate has to be; `own` is then the joint's turn or its slide
    template <class V>
    void fields(V& v) {
      v.given("joint", joint), v.given("dof", dof), v("ratio", ratio);
    }
  };
  std::string name;
  std::vector<Term> terms;
  std::optional<double> stiffness = {};  ///< per unit of the sum; derived if not given
  std::optional<double> damping = {};
  bool on = true;

  CouplingSpec switched_off() const;
};

/// Gears, between joints that turn: joint `out` turns `ratio` times as fast as joint `in`; negative where it turns the
/// other way, as outer gears do (ratio = -teeth of `in` / teeth of `out`).
CouplingSpec gear(std::string name, JointId in, JointId out, double ratio);
/// Rack and pinion: the rack slides by pinion_radius (m) times the pinion's angle. The pinion's joint has to turn, the
/// rack's to slide; of a cylindrical joint the coordinate that fits is taken.
CouplingSpec rack_and_pinion(std::string name, JointId pinion, JointId rack, double pinion_radius);
/// Screw: the nut slides by `lead` (m) for each turn. One cylindrical joint may be both.
DEM_SETUP inline CouplingSpec screw(std::string name, JointId turning, JointId sliding, double lead) {
  return rack_and_pinion(std::move(name), turning, sliding, lead / (2.0 * std::numbers::pi));
}
/// Differential: the input turns `final_ratio` times as fast as the mean of the two outputs.
CouplingSpec differential(std::string name, JointId in, JointId left, JointId right, double final_ratio);

struct Coupling {
  CouplingSpec spec;
  double k = 0.0, c = 0.0;
  double offset = 0.0;      ///< value of the sum at assembly
  double error = 0.0;       ///< value of the sum, less the offset
  double multiplier = 0.0;  ///< force per unit ratio: joint i feels ratio_i * multiplier
  template <class V>
  void fields(V& v) {
    v.given("name", spec.name), v.list("terms", spec.terms, "term"), v("on", spec.on), v("k", k), v("c", c);
    v.given("stiffness", spec.stiffness), v.given("damping", spec.damping);
    v("offset", offset), v("error", error), v("multiplier", multiplier);
  }
};

double coupling_sum(const CouplingSpec& spec, const std::vector<Joint>& joints, const std::vector<Body>& bodies);

void apply_coupling(Coupling& g, const std::vector<Joint>& joints, std::vector<Body>& bodies);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE CouplingSpec CouplingSpec::switched_off() const {
  CouplingSpec s = *this;
  s.on = false;
  return s;
}

DEM_INLINE CouplingSpec gear(std::string name, JointId in, JointId out, double ratio) {
  using enum CouplingSpec::Moves;
  return {std::move(name), {{in, ratio, Dof::own, rotation}, {out, -1.0, Dof::own, rotation}}};
}

DEM_INLINE CouplingSpec rack_and_pinion(std::string name, JointId pinion, JointId rack, double pinion_radius) {
  using enum CouplingSpec::Moves;
  return {std::move(name), {{pinion, pinion_radius, Dof::own, rotation}, {rack, -1.0, Dof::own, displacement}}};
}

DEM_INLINE CouplingSpec differential(std::string name, JointId in, JointId left, JointId right, double final_ratio) {
  using enum CouplingSpec::Moves;
  return {std::move(name),
          {{in, 1.0, Dof::own, rotation},
           {left, -0.5 * final_ratio, Dof::own, rotation},
           {right, -0.5 * final_ratio, Dof::own, rotation}}};
}

DEM_INLINE double coupling_sum(const CouplingSpec& spec, const std::vector<Joint>& joints,
                               const std::vector<Body>& bodies) {
  double sum = 0.0;
  for (const auto& term : spec.terms) {
    const Joint& j = joints[term.joint.index()];
    sum += term.ratio * coordinate_of(j, bodies[j.a], bodies[j.b], term.dof).value;
  }
  return sum;
}

DEM_INLINE void apply_coupling(Coupling& g, const std::vector<Joint>& joints, std::vector<Body>& bodies) {
  g.error = g.multiplier = 0.0;
  if (!g.spec.on) return;
  double sum = 0.0, rate = 0.0;
  for (const auto& term : g.spec.terms) {
    const Joint& j = joints[term.joint.index()];
    const Coordinate q = coordinate_of(j, bodies[j.a], bodies[j.b], term.dof);
    sum += term.ratio * q.value;
    rate += term.ratio * q.speed;
  }
  g.error = sum - g.offset;
  g.multiplier = -g.k * g.error - g.c * rate;
  for (const auto& term : g.spec.terms) {
    const Joint& j = joints[term.joint.index()];
    coordinate_of(j, bodies[j.a], bodies[j.b], term.dof).apply(term.ratio * g.multiplier, bodies[j.a], bodies[j.b]);
  }
}

}  // namespace dem::mbd

#endif
