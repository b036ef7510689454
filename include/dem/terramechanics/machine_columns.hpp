#pragma once

#include <dem/mbd/load/load.hpp>
#include <dem/mbd/solver/mechanism.hpp>
#include <dem/terramechanics/soil_columns.hpp>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dem::terramechanics {

/// Soil columns under a machine, as loads on its bodies at every evaluation of the forces. What columns remember is
/// kept once a step, when time has gone on: integrators may look at a step more than once.
///
///     MachineColumns soil(machine, {.length_x = 5, .length_y = 1, .soil = melanz_sand});
///     soil.add(wheel, std::make_shared<ColumnCylinder>(0.13, 0.16), machine.body(wheel).position());
///
/// The machine must stay where it is in memory. Its stable time step does not know the soil: a step below sqrt(m/k)
/// with k = loads()[part].stiffness is safe.
class MachineColumns {
 public:
  /// Throws Error for a field that cannot be (check_columns).
  MachineColumns(mbd::Mechanism& machine, const ColumnsSpec& spec)
      : machine_(&machine), state_(std::make_shared<State>(machine, spec)) {}

  /// A shape fixed to a body: where its frame is now (m, global) and how it is turned. `width` (m) is b of the pressure
  /// law; 0: the shape's. Returns the part's number in loads(). Throws Error for a body that is not there, no shape, or
  /// no width.
  std::size_t add(BodyId body, std::shared_ptr<const ColumnShape> shape, const Vec3& at,
                  const Mat3& rotation = Mat3::Identity(), double width = 0.0) {
    const Body& b = machine_->body(body);
    if (!shape)
      fail("body '{}' was given no shape for the soil columns; give it one, such as a ColumnCylinder", b.name);
    if (!((width > 0.0 ? width : shape->width()) > 0.0)) {
      fail("the shape of body '{}' for the soil columns tells no width, which the pressure law asks for; give one",
           b.name);
    }
    const Matrix3<double>& r = b.motion.rotation;
    bool known = false;
    for (const BodyId other : state_->bodies) known |= other == body;
    if (!known) {
      const bool first = state_->bodies.empty();
      machine_->add_load(
          mbd::custom_load("soil under " + b.name, body, [state = state_, body, first](double time, const Body&) {
            if (first) state->evaluate(time);
            return state->load_on(body);
          }));
    }
    state_->bodies.push_back(body);
    state_->parts.push_back({.shape = std::move(shape),
                             .body = b.motion,
                             .position = transpose_times(r, from_eigen(at) - b.motion.position),
                             .rotation = transposed(r) * from_eigen(rotation),
                             .width = width});
    return state_->parts.size() - 1;
  }

  SoilColumns& soil() { return state_->soil; }
  const SoilColumns& soil() const { return state_->soil; }
  /// What each part feels, in the newest evaluation of the forces.
  const std::vector<ColumnLoad>& loads() const { return state_->soil.loads(); }
  /// What became of the newest evaluation: a part that leaves the soil is told here.
  const ColumnsReport& report() const { return state_->report; }

 private:
  struct State {
    State(mbd::Mechanism& m, const ColumnsSpec& spec) : machine(&m), soil(spec) {}

    /// The first of the loads does it for all.
    void evaluate(double time) {
      if (time > evaluated && evaluated >= 0.0) {
        soil.commit();
        kept = evaluated;
      }
      for (std::size_t k = 0; k < parts.size(); ++k) parts[k].body = machine->bodies()[bodies[k].index()].motion;
      report = soil.evaluate(parts, kept >= 0.0 && time > kept ? time - kept : 0.0);
      evaluated = time;
    }
    Wrench load_on(BodyId body) const {
      Wrench sum;
      for (std::size_t k = 0; k < soil.loads().size(); ++k) {
        if (bodies[k] == body) sum = sum + Wrench{soil.loads()[k].force, soil.loads()[k].torque};
      }
      return sum;
    }

    mbd::Mechanism* machine;
    SoilColumns soil;
    std::vector<ColumnPart> parts;
    std::vector<BodyId> bodies;  ///< of the parts
    ColumnsReport report;
    double evaluated = -1.0, kept = -1.0;  ///< s, of the newest evaluation and of what is kept
  };

  mbd::Mechanism* machine_;
  std::shared_ptr<State> state_;
};

}  // namespace dem::terramechanics
