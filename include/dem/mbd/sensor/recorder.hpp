#pragma once

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
  Recorder& add(std::string column, Function<double()> value) {
    columns_.push_back(std::move(column));
    values_.push_back(std::move(value));
    row_.resize(values_.size());
    return *this;
  }
  /// All free coordinates and their speeds, reaction force and torque on its body b in global axes.
  Recorder& add(JointId id) {
    const Mechanism* m = machine_;
    known_joint(m->parts(), id, "a recorder");
    const std::string name = m->parts().joint_specs[id.index()].name;
    const JointKind kind = m->joint(id).kind;
    for (const Dof f : dofs_of(kind)) {
      const bool rotation = is_rotation(f);
      add(dem::text("{}_{}_{}", name, name_of(f), rotation ? "rad" : "m"), [m, id, f] { return m->coordinate(id, f); });
      add(dem::text("{}_{}_speed_{}_per_s", name, name_of(f), rotation ? "rad" : "m"),
          [m, id, f] { return m->speed(id, f); });
    }
    add(name + "_force_x_N", [m, id] { return m->reaction(id).force.x; });
    add(name + "_force_y_N", [m, id] { return m->reaction(id).force.y; });
    add(name + "_force_z_N", [m, id] { return m->reaction(id).force.z; });
    add(name + "_torque_x_Nm", [m, id] { return m->reaction(id).torque.x; });
    add(name + "_torque_y_Nm", [m, id] { return m->reaction(id).torque.y; });
    add(name + "_torque_z_Nm", [m, id] { return m->reaction(id).torque.z; });
    return *this;
  }
  /// Position and velocity of a body's centre of mass.
  Recorder& add(BodyId id) {
    const Mechanism* m = machine_;
    const std::string name = known_body(m->parts(), id, "a recorder").name;
    for (int k = 0; k < 3; ++k) {
      add(dem::text("{}_{}_m", name, "xyz"[k]), [m, id, k] { return m->body(id).position()[k]; });
    }
    for (int k = 0; k < 3; ++k) {
      add(dem::text("{}_v{}_m_per_s", name, "xyz"[k]), [m, id, k] { return m->body(id).velocity()[k]; });
    }
    return *this;
  }
  /// Coordinate, speed and force of an actuator.
  Recorder& add(ActuatorId id) {
    const Mechanism* m = machine_;
    if (id.index() >= m->parts().actuators.size()) fail("a recorder names an actuator that the machine does not have");
    const std::string name = m->actuator(id).spec.name;
    add(name + "_coordinate", [m, id] { return m->actuator(id).coordinate; });
    add(name + "_speed", [m, id] { return m->actuator(id).speed; });
    add(name + "_force", [m, id] { return m->actuator(id).force; });
    return *this;
  }

  const std::vector<std::string>& columns() const { return columns_; }

  /// The row of the present state; valid until the next call.
  std::span<const double> sample() {
    for (std::size_t i = 0; i < values_.size(); ++i) row_[i] = values_[i]();
    return row_;
  }

  /// True once for each `interval` (s) of time that passes, from the first call on, which is true.
  bool is_due(double time, double interval) {
    if (time < next_ - 1e-9 * interval) return false;
    next_ = (started_ ? next_ : time) + interval;
    started_ = true;
    return true;
  }

 private:
  const Mechanism* machine_;
  std::vector<std::string> columns_;
  std::vector<Function<double()>> values_;
  std::vector<double> row_;
  double next_ = -1e300;
  bool started_ = false;
};

}  // namespace dem::mbd
