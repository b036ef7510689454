#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/mechanism.hpp>

#include <dem/core/function.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// Rows of numbers about a machine, to be written by any table writer, or kept for plots (io::Columns):
///
///     Recorder recorder(machine);
///     recorder.add("time_s", [&] { return machine.time(); });
///     recorder.add(hinge);                                    // coordinate, speed and reaction of a joint
///     io::CsvWriter csv("hinge.csv", recorder.columns());
///     const auto write = [&] { if (recorder.is_due(machine.time(), 0.01)) csv.row(recorder.sample()); };
///     write();                                                // the start, t = 0
///     const auto report = machine.run(10.0, 1e-4, write);     // calls it after each step: 0.01 s, 0.02 s ...
///
/// Before the first step no force has been evaluated, so the reactions in the row of the start are 0 (after design_for
/// and initialise they are those of the start). Without that row the intervals count from the end of the first step.
/// It refers to the machine, which has to outlive it and must not be moved.
class Recorder {
 public:
  explicit Recorder(const Mechanism& machine) : machine_(&machine) {}

  /// A column of the user's own.
  Recorder& add(std::string column, Function<double()> value);
  /// All free coordinates and their speeds, reaction force and torque on its body b in global axes.
  Recorder& add(JointId id);
  /// Position and velocity of a body's centre of mass.
  Recorder& add(BodyId id);
  /// Coordinate, speed and force of an actuator; a torque, where its coordinate is a rotation.
  Recorder& add(ActuatorId id);

  /// Capacity and torque of a clutch or brake, and the rate of its slip; a force, where its first coordinate slides.
  Recorder& add(ClutchId id);

  const std::vector<std::string>& columns() const { return columns_; }

  /// The row of the present state; valid until the next call.
  std::span<const double> sample();

  /// True once for each `interval` (s) of time that passes, from the first call on, which is true.
  bool is_due(double time, double interval);

 private:
  /// How columns of a coordinate and of what drives it end.
  struct Units {
    const char *way, *effort_name, *effort;
    explicit Units(bool is_a_rotation);
  };

  const Mechanism* machine_;
  std::vector<std::string> columns_;
  std::vector<Function<double()>> values_;
  std::vector<double> row_;
  double next_ = -1e300;
  bool started_ = false;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE Recorder& Recorder::add(std::string column, Function<double()> value) {
  columns_.push_back(std::move(column));
  values_.push_back(std::move(value));
  row_.resize(values_.size());
  return *this;
}

DEM_INLINE Recorder& Recorder::add(JointId id) {
  const Mechanism* m = machine_;
  known_joint(m->parts(), id, "a recorder");
  const std::string name = m->parts().joint_specs[id.index()].name;
  const JointKind kind = m->joint(id).kind;
  for (const Dof f : dofs_of(kind)) {
    const bool rotation = is_rotation(f);
    for (const bool moving : {false, true}) {
      add(dem::text("{}_{}{}_{}{}", name, name_of(f), moving ? "_speed" : "", rotation ? "rad" : "m",
                    moving ? "_per_s" : ""),
          [m, id, f, moving] { return moving ? m->speed(id, f) : m->coordinate(id, f); });
    }
  }
  for (const bool torque : {false, true}) {
    for (int k = 0; k < 3; ++k) {
      add(dem::text("{}_{}_{}_{}", name, torque ? "torque" : "force", "xyz"[k], torque ? "Nm" : "N"),
          [m, id, torque, k] {
            const Wrench on_b = m->reaction(id);
            return to_eigen(torque ? on_b.torque : on_b.force)[k];
          });
    }
  }
  return *this;
}

DEM_INLINE Recorder& Recorder::add(BodyId id) {
  const Mechanism* m = machine_;
  const std::string name = known_body(m->parts(), id, "a recorder").name;
  for (const bool moving : {false, true}) {
    for (int k = 0; k < 3; ++k) {
      add(dem::text("{}_{}{}_{}", name, moving ? "v" : "", "xyz"[k], moving ? "m_per_s" : "m"),
          [m, id, moving, k] { return moving ? m->body(id).velocity()[k] : m->body(id).position()[k]; });
    }
  }
  return *this;
}

DEM_INLINE Recorder& Recorder::add(ActuatorId id) {
  const Mechanism* m = machine_;
  if (id.index() >= m->parts().actuators.size()) fail("a recorder names an actuator that the machine does not have");
  const ActuatorSpec& spec = m->actuator(id).spec;
  const Units units(spec.joint.valid() && is_rotation(spec.dof));
  add(dem::text("{}_coordinate_{}", spec.name, units.way), [m, id] { return m->actuator(id).coordinate; });
  add(dem::text("{}_speed_{}_per_s", spec.name, units.way), [m, id] { return m->actuator(id).speed; });
  return add(dem::text("{}_{}_{}", spec.name, units.effort_name, units.effort),
             [m, id] { return m->actuator(id).force; });
}

DEM_INLINE Recorder& Recorder::add(ClutchId id) {
  const Mechanism* m = machine_;
  const ClutchSpec& spec = m->clutch(id).spec;
  const Units units(is_rotation(spec.terms[0].dof));
  add(dem::text("{}_capacity_{}", spec.name, units.effort), [m, id] { return m->clutch(id).capacity; });
  add(dem::text("{}_{}_{}", spec.name, units.effort_name, units.effort), [m, id] { return m->clutch(id).torque; });
  return add(dem::text("{}_slip_speed_{}_per_s", spec.name, units.way), [m, id] { return m->slip_speed(id); });
}

DEM_INLINE std::span<const double> Recorder::sample() {
  for (std::size_t i = 0; i < values_.size(); ++i) row_[i] = values_[i]();
  return row_;
}

DEM_INLINE bool Recorder::is_due(double time, double interval) {
  if (time < next_ - 1e-9 * interval) return false;
  next_ = (started_ ? next_ : time) + interval;
  started_ = true;
  return true;
}

DEM_INLINE Recorder::Units::Units(bool is_a_rotation)
    : way(is_a_rotation ? "rad" : "m"),
      effort_name(is_a_rotation ? "torque" : "force"),
      effort(is_a_rotation ? "Nm" : "N") {}

}  // namespace dem::mbd

#endif
