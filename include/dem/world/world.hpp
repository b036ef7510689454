#pragma once

#include <dem/pipeline/stable_time_step.hpp>
#include <dem/world/check.hpp>
#include <dem/world/report.hpp>
#include <dem/world/step.hpp>

#include <utility>

namespace dem {

/// A simulation: grains, machine, and the laws between them, specialised at compile time for a Model.
template <class M>
class World {
 public:
  using Model = M;
  using Shape = typename Model::Shape;
  using Machine = mbd::Machine<typename Model::Integrator>;
  using Parameters = ContactParameters<Model>;
  static_assert(check_model<Model>());

  /// Throws Error if an option is out of range.
  explicit World(const WorldOptions& options = {}) {
    require_non_negative(options.time_step, "time step", "s (0 chooses one)");
    require_within(options.time_step_safety, 1e-6, 1.0, "time step safety");
    require_non_negative(options.skin, "skin", "m (0 chooses one)");
    require_positive(options.overlap_limit, "overlap limit", "effective diameters");
    require_finite(options.gravity, "gravity");
    if (const auto& d = options.domain; d && !(d->low.array() < d->high.array()).all()) {
      fail("the domain's lower corner ({:g}, {:g}, {:g}) m is not below its upper one, ({:g}, {:g}, {:g}) m",
           d->low.x(), d->low.y(), d->low.z(), d->high.x(), d->high.y(), d->high.z());
    }
    state_.options = options;
    if (options.threads != 0) state_.executor.set_threads(options.threads);
  }

  // ---- set-up ----------------------------------------------------------------------------------------------------

  /// A kind of grain. Throws Error unless the density is positive.
  SpeciesId add_species(const Shape& shape, const SpeciesOptions& o = {}) {
    require_positive(o.density, "density of a species", "kg/m^3");
    const MaterialId material = state_.materials.id(o.material);
    state_.materials.mark_as_grain(material);
    const Species<Shape> s = {shape,
                              material,
                              o.density,
                              o.density * shape.volume(),
                              1.0 / (o.density * shape.volume()),
                              o.density * shape.unit_inertia()};
    SpeciesInertia numbers = {1.0 / s.mass, 1.0, {}, {}};
    for (int k = 0; k < 3; ++k) {
      numbers.inertia[k] = s.inertia[k];
      numbers.inverse_inertia[k] = 1.0 / s.inertia[k];
    }
    state_.species.push_back(s);
    state_.inertia.push_back(numbers);
    state_.largest_radius = std::max(state_.largest_radius, shape.bounding_radius());
    checked_ = false;
    return SpeciesId(state_.species.size() - 1);
  }

  /// Contact constants for every pair of materials that has none of its own. Throws Error if one makes no sense.
  void set_contact(const Parameters& p) {
    state_.materials.set_default(p);
    checked_ = false;
  }
  /// Contact constants for one pair of materials.
  void set_contact(std::string_view a, std::string_view b, const Parameters& p) {
    state_.materials.set(a, b, p);
    checked_ = false;
  }

  /// Adds a grain. Throws Error for an unknown species, a position that is not finite, or a rotation that is none.
  ParticleId add_particle(const NewParticle& n) {
    auto& p = state_.particles;
    if (n.species.index() >= state_.species.size()) {
      fail("a grain was given species {}, but the world has {}; call add_species first", n.species.value,
           state_.species.size());
    }
    if (!n.position.allFinite() || !n.velocity.allFinite() || !n.angular_velocity.allFinite()) {
      fail("grain {} was given a position or velocity that is not finite", p.count);
    }
    // Written such that a NaN fails as well.
    if (!((n.rotation.transpose() * n.rotation - Mat3::Identity()).norm() <= 1e-6) ||
        !(n.rotation.determinant() > 0.0)) {
      fail("grain {} was given a rotation matrix that is no rotation; normalise it (R^T R = I, det R = 1)", p.count);
    }
    const std::size_t row = p.count;
    p.resize(row + 1);
    p.position.set(row, from_eigen(n.position));
    p.velocity.set(row, from_eigen(n.velocity));
    const Mat3 rotation = Shape::has_orientation ? n.rotation : Mat3(Mat3::Identity());
    p.set_rotation(row, from_eigen(rotation));
    p.spin.set(row, from_eigen(Vec3(rotation.transpose() * n.angular_velocity)));
    p.species[row] = n.species.value;
    p.id[row] = static_cast<std::uint32_t>(p.row_of.size());
    p.row_of.push_back(static_cast<std::uint32_t>(row));
    touched();
    return ParticleId(p.row_of.size() - 1);
  }

  /// Bodies, joints, actuators, sensors.
  Machine& machine() { return state_.machine; }
  const Machine& machine() const { return state_.machine; }
  /// The fixed body of the world: carries walls that never move.
  BodyId ground() { return state_.machine.ground(); }

  /// Gives a body a surface that grains feel.
  SurfaceId add_surface(BodyId body, const typename Model::Surfaces& geometry, const SurfaceOptions& o = {}) {
    if (body.index() >= state_.machine.bodies().size()) {
      fail("surface '{}' was given body {}, but the machine has {}", o.name, body.value,
           state_.machine.bodies().size());
    }
    // Written such that a NaN fails as well: a wall whose place is not known would let everything through.
    if (!o.position.allFinite() || !((o.rotation.transpose() * o.rotation - Mat3::Identity()).norm() <= 1e-6) ||
        !(o.rotation.determinant() > 0.0)) {
      fail(
          "surface '{}' was given a position that is not finite or a rotation matrix that is no rotation (R^T R = I, "
          "det R = 1)",
          o.name);
    }
    if (state_.surfaces.size() >= 0xffff) fail("a world takes at most 65,535 surfaces");
    typename WorldState<Model>::Surface s{o.name,   body,       state_.materials.id(o.material),
                                          geometry, o.position, o.rotation};
    state_.surfaces.push_back(s);
    checked_ = false;
    return SurfaceId(state_.surfaces.size() - 1);
  }
  /// Lets two surfaces of different bodies touch each other, with the contact constants of their materials. Each shows
  /// its points (corners, vertices, rims) to the other; a plane has none. Throws Error for surfaces of one body, of two
  /// fixed bodies, or that both have no points.
  BodyContactId add_body_contact(SurfaceId a, SurfaceId b) {
    auto& w = state_;
    const auto &sa = known(w.surfaces, a, "surface"), &sb = known(w.surfaces, b, "surface");
    const Body &body_a = w.machine.body(sa.body), &body_b = w.machine.body(sb.body);
    if (sa.body == sb.body) {
      fail("surfaces {} and {} both belong to body '{}' and cannot touch each other", a.value, b.value, body_a.name);
    }
    if (body_a.fixed && body_b.fixed) {
      fail("body '{}' and body '{}' are both fixed, so no force between them would move anything", body_a.name,
           body_b.name);
    }
    if (pipeline::points_at_once(sa) + pipeline::points_at_once(sb) == 0) {
      fail("neither surface {} nor surface {} has points that could touch the other (planes have none)", a.value,
           b.value);
    }
    if (w.body_contacts.pairs.size() >= pipeline::BodyKey::most_pairs) {
      fail("a world takes at most {} body contacts", pipeline::BodyKey::most_pairs);
    }
    w.body_contacts.pairs.push_back({a, b});
    checked_ = initialised_ = false;
    return BodyContactId(w.body_contacts.pairs.size() - 1);
  }
  /// Lets all surfaces touch each other that were added so far, but for those of one body, of two fixed bodies, or of
  /// bodies that a joint connects (one of kind `free` only measures); pairs that are known already are not added again.
  /// Returns how many pairs were added.
  std::size_t add_body_contacts() {
    const auto& w = state_;
    std::size_t added = 0;
    for (std::size_t a = 0; a < w.surfaces.size(); ++a) {
      for (std::size_t b = a + 1; b < w.surfaces.size(); ++b) {
        const BodyId i = w.surfaces[a].body, j = w.surfaces[b].body;
        bool skip = i == j || (w.machine.body(i).fixed && w.machine.body(j).fixed) ||
                    pipeline::points_at_once(w.surfaces[a]) + pipeline::points_at_once(w.surfaces[b]) == 0;
        for (const auto& joint : w.machine.parts().joints) {
          if (joint.kind == mbd::JointKind::free) continue;
          skip |= (joint.a == i.value && joint.b == j.value) || (joint.a == j.value && joint.b == i.value);
        }
        for (const auto& pair : w.body_contacts.pairs) {
          skip |= (pair.a.index() == a && pair.b.index() == b) || (pair.a.index() == b && pair.b.index() == a);
        }
        if (skip) continue;
        add_body_contact(SurfaceId(a), SurfaceId(b));
        ++added;
      }
    }
    return added;
  }
  /// Force (N) on the body of the pair's first surface in the last force evaluation; the other body feels the opposite.
  Vec3 body_contact_force(BodyContactId c) const {
    return to_eigen(known(state_.body_contacts.pairs, c, "body contact").force);
  }

  /// A sensor of the grains' force and torque on one surface, e.g. a wall of a body that has several; the mean is taken
  /// over `window` (s). The machine's own sensors measure whole bodies. Throws Error for an unknown surface.
  SurfaceSensorId add_surface_sensor(SurfaceId surface, double window) {
    known(state_.surfaces, surface, "surface");
    state_.surface_sensors.push_back({surface, mbd::WindowAverage(window)});
    return SurfaceSensorId(state_.surface_sensors.size() - 1);
  }

  /// Lets a surface touch grains and bodies, or not.
  void set_active(SurfaceId s, bool active) { known(state_.surfaces, s, "surface").active = active; }

  // ---- running ---------------------------------------------------------------------------------------------------

  /// Checks the set-up and chooses or checks the time step; called by step() and run() when something changed. Throws
  /// Error if contact constants are missing or the time step is too large.
  void prepare() {
    if (!checked_ || (initialised_ && !state_.machine.is_initialised())) {
      state_.materials.check_complete();
      state_.materials.check_names(used_materials());
      const double range = state_.materials.range();
      state_.materials.find_range(state_.largest_radius);
      if (state_.materials.range() > range) state_.list_valid = false;
      for (const auto& pair : state_.body_contacts.pairs) {
        state_.materials.check_pair(state_.surfaces[pair.a.index()].material, state_.surfaces[pair.b.index()].material);
      }
      // A machine that was changed is judged by what is derived for it as it is now.
      if (time_step() > 0.0 && !state_.machine.is_initialised()) state_.machine.design_for(time_step());
      choose_time_step();
      checked_ = true;
    }
    if (!initialised_ || !state_.machine.is_initialised()) {
      // What is derived depends on the pose: it changes with the machine or the time step, not with the grains.
      if (!state_.machine.is_designed_for(time_step())) state_.machine.design_for(time_step());
      initialise(state_);
      initialised_ = true;
    }
  }
  [[nodiscard]] StepReport step() { return run(1); }
  /// Runs n steps, or fewer if a problem shows. A lost grain is reported once: a run may go on without it.
  [[nodiscard]] StepReport run(std::uint64_t n) {
    prepare();
    for (std::uint64_t k = 0; k < n; ++k) {
      advance(state_);
      if (StepReport report = find_problem(state_); !report) return report;
    }
    return ok();
  }
  /// Runs for a time span (s) in whole steps; what a span leaves of a step counts in the next one.
  [[nodiscard]] StepReport run_for(double seconds) {
    prepare();
    owed_steps_ += require_non_negative(seconds, "time to run", "s") / time_step();
    const double whole = std::max(0.0, std::round(owed_steps_));
    owed_steps_ -= whole;
    return run(static_cast<std::uint64_t>(whole));
  }

  double time() const { return state_.time; }
  std::uint64_t steps() const { return state_.step; }
  double time_step() const { return state_.time_step; }
  /// Largest stable time step of grains and machine, and what limits it.
  pipeline::StableTimeStep stable_time_step() const {
    std::vector<pipeline::SurfaceMatter> of_surfaces;
    for (const auto& s : state_.surfaces) {
      of_surfaces.push_back({s.material, pipeline::softness_of(s, state_.machine.bodies()[s.body.index()], 0.0)});
    }
    auto limit =
        pipeline::stable_time_step<Model>(state_.species, state_.materials, of_surfaces, state_.options.overlap_limit);
    const auto bodies = pipeline::stable_time_step_of_bodies<Model>(
        state_.body_contacts.pairs, std::span(state_.surfaces), std::span(state_.machine.bodies()), state_.materials,
        state_.options.overlap_limit);
    if (bodies.value < limit.value) limit = bodies;
    const auto machine = state_.machine.stable_time_step();
    if (machine.dt < limit.value) limit = {machine.dt, machine.limited_by};
    return limit;
  }
  void set_threads(int n) { state_.executor.set_threads(n); }
  int threads() const { return state_.executor.threads(); }
  void set_gravity(const Vec3& g) {
    require_finite(g, "gravity");
    state_.options.gravity = g;
    initialised_ = false;
  }

  // ---- looking -----------------------------------------------------------------------------------------------------

  std::size_t particle_count() const { return state_.particles.count; }
  Vec3 position(ParticleId p) const { return to_eigen(state_.particles.position[row(p)]); }
  Vec3 velocity(ParticleId p) const { return to_eigen(state_.particles.velocity[row(p)]); }
  Vec3 angular_velocity(ParticleId p) const { return to_eigen(state_.particles.angular_velocity(row(p))); }
  Mat3 rotation(ParticleId p) const { return to_eigen(state_.particles.rotation(row(p))); }
  /// Contact force (N) and torque (N m) on a grain in the last force evaluation.
  Vec3 force(ParticleId p) const { return to_eigen(state_.particles.force[row(p)]); }
  Vec3 torque(ParticleId p) const { return to_eigen(state_.particles.torque[row(p)]); }
  SpeciesId species_of(ParticleId p) const { return SpeciesId(state_.particles.species[row(p)]); }
  const Species<Shape>& species(SpeciesId s) const { return known(state_.species, s, "species"); }

  void set_velocity(ParticleId p, const Vec3& v) {
    require_finite(v, "velocity of a grain");
    state_.particles.velocity.set(row(p), from_eigen(v));
    initialised_ = false;
  }

  /// Force (N) that the grains exert on a surface, from the last force evaluation.
  Vec3 surface_force(SurfaceId s) const { return to_eigen(known(state_.surfaces, s, "surface").force); }
  /// Torque (N m) of the grains on a surface about its body's centre of mass.
  Vec3 surface_torque(SurfaceId s) const { return to_eigen(known(state_.surfaces, s, "surface").torque); }
  /// Force (N) and torque (N m, about its body's centre of mass) of the grains on a sensor's surface, now and averaged.
  const mbd::WindowAverage& surface_sensor(SurfaceSensorId s) const {
    return known(state_.surface_sensors, s, "surface sensor").average;
  }

  const WorldState<Model>& state() const { return state_; }
  WorldState<Model>& state() { return state_; }

 private:
  std::size_t row(ParticleId p) const { return known(state_.particles.row_of, p, "grain"); }
  /// What an id names. Throws Error for an id that this world never gave.
  template <class List, class Id>
  static auto& known(List& list, Id id, const char* what) {
    if (id.index() < list.size()) return list[id.index()];
    if (!id.valid()) fail("a {} is asked for by an id that was never set; use the one that the world returned", what);
    fail("{} {} is asked for, but this world has {}; use the id that it returned", what, id.value, list.size());
  }
  static void require_finite(const Vec3& v, const char* what) {
    if (!v.allFinite()) fail("{} is ({:g}, {:g}, {:g}), but must be finite", what, v.x(), v.y(), v.z());
  }
  std::vector<MaterialId> used_materials() const {
    std::vector<MaterialId> used;
    for (const auto& s : state_.species) used.push_back(s.material);
    for (const auto& s : state_.surfaces) used.push_back(s.material);
    return used;
  }
  /// Grains came or were moved by hand.
  void touched() {
    state_.list_valid = false;
    initialised_ = false;
  }
  StepReport ok() const { return {StepReport::Problem::none, state_.time, state_.step, {}, {}}; }

  void choose_time_step() {
    const pipeline::StableTimeStep limit = stable_time_step();
    const WorldOptions& o = state_.options;
    if (o.time_step == 0.0) {
      if (limit.value >= 1e300) fail("nothing in the world limits the time step; set time_step");
      // A step that was chosen before is kept while it is as safe: a change of friction must not change it.
      const double safe = o.time_step_safety * limit.value;
      if (state_.time_step == 0.0 || state_.time_step > (1.0 + 1e-12) * safe) state_.time_step = safe;
      return;
    }
    if (o.time_step > limit.value && !o.allow_unstable_time_step) {
      fail(
          "time step {:g} s is above the largest stable one, {:.4g} s ({}); lower time_step or the stiffness, or set "
          "allow_unstable_time_step",
          o.time_step, limit.value, limit.contact);
    }
    state_.time_step = o.time_step;
  }

  WorldState<Model> state_;
  bool checked_ = false, initialised_ = false;
  double owed_steps_ = 0.0;  // by run_for: less than one
};

}  // namespace dem
