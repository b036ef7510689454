#pragma once

#include <dem/core/known.hpp>
#include <dem/core/macros.hpp>
#include <dem/world/body_contacts.hpp>
#include <dem/world/held_grains.hpp>
#include <dem/world/period.hpp>
#include <dem/world/put_in.hpp>
#include <dem/world/take_out.hpp>

#include <algorithm>
#include <cstdint>
#include <initializer_list>

namespace dem {

/// Nothing is made of it; see WorldSetup's constructor.
struct NoOptions {
  NoOptions() = delete;
};

/// What a world is made of: everything that is added to it before it runs, or between runs. World adds the running.
template <class M>
class WorldSetup {
 public:
  using Model = M;
  using Shape = typename Model::Shape;
  using Parameters = ContactParameters<Model>;
  static_assert(check_model<Model>());

  /// All options as they are; `World<Sand> w({})` means it too, where the braces could else be a world to copy.
  explicit WorldSetup(std::initializer_list<NoOptions>) : WorldSetup() {}
  /// Throws Error if an option is out of range.
  explicit WorldSetup(const WorldOptions& options = {}) {
    detail::check_options(options);
    state_.options = options;
    set_period(state_);
    if (options.threads != 0) state_.executor.set_threads(options.threads);
    else if constexpr (Model::Domain::has_ranks) state_.executor.set_threads(Model::Domain::threads_of_a_rank());
  }

  /// A kind of grain. Throws Error unless the density, and the volume and radius of the shape, are positive, and for
  /// moments of inertia that no body has.
  DEM_SETUP SpeciesId add_species(const Shape& shape, const SpeciesOptions& o = {}) {
    require_no_step("add_species");
    Species<Shape> s = make_species(shape, o.density, o.held);
    s.material = state_.materials.id(o.material);
    state_.materials.mark_as_grain(s.material);
    state_.species.push_back(s);
    state_.inertia.push_back(s.for_motion());
    state_.largest_radius = std::max(state_.largest_radius, shape.bounding_radius());
    state_.smallest_radius = std::min(state_.smallest_radius, shape.bounding_radius());
    checked_ = false;
    return SpeciesId(state_.species.size() - 1);
  }

  /// Contact constants for every pair of materials that has none of its own. Wakes all grains. Throws Error if one
  /// makes no sense.
  DEM_SETUP void set_contact(const Parameters& p) {
    require_no_step("set_contact");
    require_grains_here("a change of contact constants");
    state_.materials.set_default(p);
    wake_all(state_);
    checked_ = false;
  }
  /// Contact constants for one pair of materials, named. Wakes all grains. Throws Error if one makes no sense.
  DEM_SETUP void set_contact(std::string_view a, std::string_view b, const Parameters& p) {
    require_no_step("set_contact");
    require_grains_here("a change of contact constants");
    state_.materials.set(a, b, p);
    wake_all(state_);
    checked_ = false;
  }

  /// Adds a grain. In a world that runs, all others go on as they were; the new one begins with weight alone, so that
  /// what it touches already acts on it from the next evaluation on. Throws Error for an unknown species, a position
  /// that is not finite, or a rotation that is none.
  GrainId add_grain(const NewGrain& n) {
    require_no_step("add_grain");
    require_between_runs("a new grain");
    auto& p = state_.grains;
    const std::uint32_t id = p.given;
    if (!n.species.valid()) fail("grain {} was given no species; use the SpeciesId that add_species returned", id);
    if (n.species.index() >= state_.species.size()) {
      fail("grain {} was given species {}, but the world has {}; call add_species first", id, n.species.value,
           state_.species.size());
    }
    if (!is_finite(n.position) || !is_finite(n.velocity) || !is_finite(n.angular_velocity)) {
      fail("grain {} was given a position or velocity that is not finite", id);
    }
    if (state_.species[n.species.index()].is_held() &&
        !(n.velocity == Vec3::Zero() && n.angular_velocity == Vec3::Zero())) {
      fail("grain {} is of a species that is held, but was given a velocity; attach it to a part that moves", id);
    }
    // Written such that a NaN fails as well.
    if (!(distance_from_rotation(n.rotation) <= 1e-6)) {
      fail("grain {} was given a rotation matrix that is no rotation; normalise it (R^T R = I, det R = 1)", id);
    }
    const Mat3 rotation = Shape::has_orientation ? n.rotation : Mat3(Mat3::Identity());
    const std::size_t row = p.append(n.species.value, from_eigen(n.position), from_eigen(n.velocity),
                                     from_eigen(rotation), from_eigen(Vec3(rotation.transpose() * n.angular_velocity)));
    state_.list_valid = false;
    state_.grains_added = true;
    state_.placed.grain(state_.step, p.id[row]);
    begin_to_fall(state_, row);
    return p.name(p.id[row]);
  }

  /// Attaches a grain of a species that is held (SpeciesOptions::held) to a body, as if glued to it where both are now:
  /// the body carries it from here on, and feels the forces on it. Its mass is not added to the body's. Attached to
  /// ground() it stands still, as one that is not attached does, and loads the ground. Throws Error for an unknown
  /// body, and for a species of grains that move.
  DEM_SETUP void attach(GrainId p, BodyId body) {
    require_no_step("attach");
    if (!state_.species[state_.grains.species[row(p)]].is_held()) {
      fail("grain {} is to be attached to a body, but moves by itself; make its species with SpeciesOptions::held",
           p.value);
    }
    known(state_.machine.bodies(), body, "body");
    if (domain::IsSheared<typename Model::Domain>) fail("grains of a sheared cell cannot be attached to a body");
    attach_grain(state_, row(p), body);
    initialised_ = false;
  }
  /// Takes a grain out of the world; its number is not given again. The ids of others stay.
  void remove_grain(GrainId p) {
    require_no_step("remove_grain");
    const std::size_t at = row(p);
    take_out_row(state_, at, state_.grains.id[at]);
    touched();
  }
  /// A box that takes grains out while the world runs, and counts them: an outlet of a silo, the end of a conveyor. It
  /// may be without end: {{-1, -1, -HUGE_VAL}, {1, 1, -0.1}} takes what falls below z = -0.1 m. A grain that is taken
  /// is gone at once for who looks; others feel it for up to 16 steps more, until the next neighbour list. One
  /// that crosses the box within a step is not taken: make the box thicker than the fastest goes in a step. Throws
  /// Error for a box that is none.
  DEM_SETUP OutletId add_outlet(const surface::Aabb& region, const OutletOptions& o = {}) {
    require_no_step("add_outlet");
    require_grains_here("a new outlet");
    state_.outlets.emplace_back(region, o);
    return OutletId(state_.outlets.size() - 1);
  }

  /// A region that puts grains in while the world runs: a flow of mass or of grains. They come in batches, some steps
  /// apart. Throws Error for an unknown species and for options that make no sense. What does not fit is owed, and
  /// StepReport::note tells of it.
  ///
  ///     world.add_inlet(InletRegion::disc({0, 0, 0.3}, {0, 0, -1}, 0.02), {.grains = sand, .mass_flow = 0.1});
  DEM_SETUP InletId add_inlet(const InletRegion& region, const InletOptions& o) {
    require_no_step("add_inlet");
    require_grains_here("a new inlet");
    const auto mass_of = [&](SpeciesId s) {
      const auto& kind = known(state_.species, s, "species");
      if (kind.is_held()) fail("inlet '{}' is to give grains of species {}, which is held", o.name, s.value);
      return kind.mass;
    };
    check_region(state_, region.bounds(), o.name);
    state_.inlets.emplace_back(region, o, MixtureDraw(o.grains, mass_of), state_.time);
    state_.put_in = &dem::put_in<Model>;
    return InletId(state_.inlets.size() - 1);
  }
  /// Opens or closes an inlet, as a valve does. A new one is open. While it is closed it puts nothing in, and nothing
  /// falls due. Throws Error for an unknown inlet.
  void set_open(InletId i, bool open) { known(state_.inlets, i, "inlet").set_open(open, state_.time); }

  /// Bodies, joints, actuators, sensors. The world moves them. Only programs that call this compile what does.
  mbd::Mechanism& machine() {
    state_.machine_solver.take_on();
    return state_.machine;
  }
  const mbd::Mechanism& machine() const { return state_.machine; }
  /// Columns of semi-empirical soil under the machine, of a terramechanics::ColumnsSpec; include
  /// <dem/terramechanics/machine_columns.hpp>, which says what is returned: a MachineColumns.
  template <class Spec>
  auto add_soil_columns(const Spec& spec) {
    return make_soil_columns(machine(), spec);
  }
  /// The fixed body of the world: carries walls that never move.
  BodyId ground() { return state_.machine.ground(); }

  /// Gives a body a surface that grains feel. Its place is by default that in the body's reference frame, that of the
  /// drawing or the mesh that the body was made from. Throws Error for an unknown body, a rotation that is none, and
  /// more than 65,535 surfaces.
  template <class Kind>
  requires surface::is_one_of<Kind, typename Model::Surfaces> SurfaceId add_surface(BodyId body, const Kind& geometry,
                                                                                    const SurfaceOptions& o = {}) {
    return place_surface(body, geometry, o, coupling::code_for<Model, Kind>());
  }
  /// The same of a kind that is known when the program runs.
  SurfaceId add_surface(BodyId body, const typename Model::Surfaces& geometry, const SurfaceOptions& o = {}) {
    return place_surface(
        body, geometry, o,
        std::visit([]<class Kind>(const Kind&) { return coupling::code_for<Model, Kind>(); }, geometry));
  }
  /// Lets two surfaces of different bodies touch each other, with the contact constants of their materials. Each shows
  /// its points (corners, vertices, rims) to the other; a plane has none. Throws Error for surfaces of one body, of two
  /// fixed bodies without mass (which cannot be set free), or that both have no points.
  BodyContactId add_body_contact(SurfaceId a, SurfaceId b) {
    require_no_step("add_body_contact");
    const BodyContactId pair = detail::add_body_contact(state_, a, b);
    checked_ = initialised_ = false;
    return pair;
  }
  /// Lets all surfaces that were added so far touch each other. Left out are pairs of one body, of two fixed bodies
  /// without mass, and of bodies that a joint connects (but not by one of kind `free`, which only measures). Pairs that
  /// are known already are not added again. Any number of pairs costs little: only those whose bounding boxes meet are
  /// looked at. Returns how many pairs were added.
  std::size_t add_body_contacts() {
    require_no_step("add_body_contacts");
    checked_ = initialised_ = false;  // first: some may be added before one is refused
    return detail::add_body_contacts(state_);
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

  /// Lets a surface touch grains and bodies, or not. Throws Error for an unknown surface.
  void set_active(SurfaceId s, bool active) {
    auto& surface = known(state_.surfaces, s, "surface");
    if (surface.active != active) wake_all(state_);
    if (active && !surface.active) {
      state_.placed.surface(state_.step, s.index());
      state_.new_surfaces.add(s.index());
    }
    surface.active = active;
  }

 protected:
  DEM_SETUP SurfaceId place_surface(BodyId body, const typename Model::Surfaces& geometry, const SurfaceOptions& o,
                                    const coupling::SurfaceCode<Model>& code) {
    require_no_step("add_surface");
    mbd::known_body(state_.machine.parts(), body, text("surface '{}'", o.name));
    // Written such that a NaN fails as well: a wall whose place is not known would let everything through.
    if (!is_finite(o.position) || !(distance_from_rotation(o.rotation) <= 1e-6)) {
      fail(
          "surface '{}' was given a position that is not finite or a rotation matrix that is no rotation (R^T R = I, "
          "det R = 1)",
          o.name);
    }
    if (state_.surfaces.size() >= 0xffff) fail("a world takes at most 65,535 surfaces");
    Vec3 position = o.position;
    Mat3 rotation = o.rotation;
    if (o.frame == BodyFrame::reference) {
      const mbd::BuiltBody& built = state_.machine.parts().built[body.index()];
      position = built.reference_origin + built.reference_axes * o.position;
      rotation = built.reference_axes * o.rotation;
    }
    SurfaceOnBody s;
    s.name = o.name, s.body = body, s.material = state_.materials.id(o.material);
    s.position = position, s.rotation = rotation;
    state_.surfaces.emplace_back(std::move(s), geometry);
    state_.find_hits.push_back(code.find_hits);
    state_.is_buried.push_back(code.is_buried);
    state_.placed.surface(state_.step, state_.surfaces.size() - 1);
    state_.new_surfaces.add(state_.surfaces.size() - 1);
    state_.sleepers.all_work = true;  // it may stand still in grains that sleep
    checked_ = false;
    return SurfaceId(state_.surfaces.size() - 1);
  }
  std::size_t row(GrainId p) const {
    require_between_runs("a grain");
    const auto& grains = state_.grains;
    const std::uint32_t at = grains.find(p), row = at == grains.gone ? grains.gone : grains.row_of[at];
    if (row != grains.gone) [[likely]]
      return row;
    if (p.value >= grains.given) fail_unknown(p, grains.given, "grain");
    fail("grain {} is asked for, but it was removed", p.value);
  }
  void require_between_runs(const char* what) const { dem::require_between_runs(state_, what); }
  void require_grains_here(const char* what) const { dem::require_grains_here(state_, what); }
  /// Throws Error where a step is under way.
  void require_no_step(const char* call) const {
    if (!state_.machine.parts().is_stepping) [[likely]]
      return;
    fail(
        "{} is called within a step of this world, from a load, a signal or a law, or by another thread; call it "
        "between steps, or in goes_on() of run(n, goes_on)",
        call);
  }
  /// The row of a grain that moves by itself.
  std::size_t row_that_moves(GrainId p) const {
    const std::size_t r = row(p);
    if (state_.species[state_.grains.species[r]].is_held()) {
      fail("grain {} is held and cannot be moved by hand; move the body that it is attached to", p.value);
    }
    return r;
  }
  /// Grains were taken out or moved by hand.
  void touched() {
    state_.list_valid = false;
    initialised_ = false;
  }

  WorldState<Model> state_;
  bool checked_ = false, initialised_ = false;
};

}  // namespace dem
