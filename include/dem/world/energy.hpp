#pragma once

#include <dem/world/contacts.hpp>
#include <dem/world/gather.hpp>

#include <limits>

namespace dem {

/// The energies of a world's grains, in J. Those of a machine are mbd::energy_of.
struct GrainEnergy {
  double translation = 0.0, rotation = 0.0;  ///< of motion
  double potential = 0.0;                    ///< against gravity, from the origin
  double normal_springs = 0.0;               ///< of the normal law
  double friction_springs = 0.0;
  double rolling_springs = 0.0;  ///< of rolling resistance and torsion
  double cohesion = 0.0;         ///< negative where grains hold each other

  // Since count_energy(); zero without it.
  double dissipated_normal = 0.0;    ///< by the dampers of the normal law, or its plastic flow
  double dissipated_friction = 0.0;  ///< by sliding, the dampers of friction, and springs that let go
  double dissipated_rolling = 0.0;   ///< by rolling resistance and torsion
  double dissipated_asleep = 0.0;    ///< motion of grains that fell asleep
  double by_surfaces = 0.0;          ///< work of machine parts, and of held grains, on the grains
  double came = 0.0;                 ///< what grains that were added had, less what those had that went

  double kinetic() const { return translation + rotation; }
  double elastic() const { return normal_springs + friction_springs + rolling_springs + cohesion; }
  double dissipated() const { return dissipated_normal + dissipated_friction + dissipated_rolling + dissipated_asleep; }
  /// What stays the same while energy is counted, but for the integrator's error.
  double balance() const { return kinetic() + potential + elastic() + dissipated() - by_surfaces - came; }
};

namespace detail {

/// Integrators that evaluate where a step ends remember springs as they are there. The others remember them as they
/// were before the grains moved on.
template <class Integrator>
inline constexpr bool evaluates_at_end = Integrator::predicts_before_forces || Integrator::stages > 1;

/// Adds what a contact stores, of laws that tell it.
template <class Model>
void add_stored(const Contact<Model>& c, const ContactParameters<Model>& p, GrainEnergy& e) {
  const ContactHistory<Model, double>& h = evaluates_at_end<typename Model::Integrator> ? c.last : c.history;
  const contact::NormalState<double> gap = {c.overlap, 0.0, c.effective_radius, 1.0, 0.0};
  contact::NormalState<double> touching = gap;
  touching.overlap = std::max(0.0, c.overlap);
  if constexpr (requires { Model::Normal::energy(p.normal, touching, h.normal); })
    e.normal_springs += c.weight * Model::Normal::energy(p.normal, touching, h.normal);
  if constexpr (requires { Model::Friction::energy(p.friction, h.friction); })
    e.friction_springs += c.weight * Model::Friction::energy(p.friction, h.friction);
  if constexpr (requires { Model::Rolling::energy(p.rolling, 1.0, h.rolling); })
    e.rolling_springs += c.weight * Model::Rolling::energy(p.rolling, c.effective_radius, h.rolling);
  if constexpr (requires { Model::Cohesion::energy(p.cohesion, gap, h.cohesion); })
    e.cohesion += c.weight * Model::Cohesion::energy(p.cohesion, gap, h.cohesion);
}

/// J, kinetic (translation, rotation) and potential of the grain of a row; none of a held one, which is a part of what
/// holds it.
template <class Model>
GrainEnergy energy_of_row(const WorldState<Model>& w, std::size_t row) {
  const auto& p = w.grains;
  const auto& kind = w.species[p.species[row]];
  const Vector3<double> v = p.velocity[row], s = p.local_angular_velocity[row];
  GrainEnergy e;
  if (kind.is_held()) return e;
  e.translation = 0.5 * kind.mass * dot(v, v);
  e.rotation = 0.5 * (kind.inertia[0] * s.x * s.x + kind.inertia[1] * s.y * s.y + kind.inertia[2] * s.z * s.z);
  e.potential = -kind.mass * dot(from_eigen(w.options.gravity), p.position[row]);
  return e;
}

/// Keeps the contacts of a chunk that were just evaluated. Called by whichever thread works on the chunk.
template <class Model>
void record_contacts(WorldState<Model>& w, std::size_t c, ContactScratch<Model>& scratch) {
  Chunk<Model>& chunk = w.chunks[c];
  const auto& p = w.grains;
  chunk.work.clear();
  const auto add = [&](const grain::Hit& hit, std::uint32_t partner, bool on_surface, const PartnerView& own,
                       const PartnerView& other, const contact::Geometry<double>& g, const grain::ContactForces& forces,
                       std::size_t k) {
    const Vector3<double> force = grain::ContactForces::at(forces.force, k);
    chunk.work.push_back({p.id[hit.i], partner, on_surface, g.normal, g.arm, g.arm - (other.position - own.position),
                          force, grain::ContactForces::at(forces.torque_i, k) - cross(g.arm, force)});
  };
  const grain::ChunkPairs<Model, std::remove_cvref_t<decltype(p)>> pairs{chunk, p, w.species, w.materials,
                                                                         c * chunk_size};
  for (std::size_t k = 0; k < scratch.pairs.hits.size(); ++k) {
    const grain::Hit& hit = scratch.pairs.hits[k];
    add(hit, p.id[hit.partner], false, p.view[hit.i], p.view[hit.partner],
        grain::contact_point_of_hit<Model>(pairs, scratch.pairs, k).geometry(), scratch.pairs.forces, k);
  }
  for (std::size_t k = 0; k < scratch.surfaces.hits.size(); ++k) {
    const grain::Hit& hit = scratch.surfaces.hits[k];
    add(hit, hit.partner, true, coupling::view_of<Model>(scratch.surfaces, k, p), w.surfaces[hit.partner].view,
        scratch.surfaces.contact_points[k].geometry(), scratch.surfaces.forces, k);
  }
}

/// Appends the contacts of a step, in the order of chunks; where ranks share the grains those of all.
template <class Model>
void append_contacts(const WorldState<Model>& w, std::vector<grain::ContactWork>& to) {
  const auto [begin, end] = w.own_chunks();
  for (std::size_t c = begin; c < end; ++c) to.insert(to.end(), w.chunks[c].work.begin(), w.chunks[c].work.end());
  if constexpr (Model::Domain::has_ranks) to = w.domain.gathered(to);
}

/// Every rank knows how all grains move. What else it has of other ranks' rows stays old.
template <class Model>
void gather_motion(WorldState<Model>& w) {
  if (!w.domain.is_shared()) return;
  gather_names(w);
  auto& p = w.grains;
  const auto gather = [&](Columns3& columns) {
    columns.for_each_column([&](AlignedVector<double>& column) { w.domain.gather_chunks(column.data(), chunk_size); });
  };
  gather(p.position), gather(p.velocity), gather(p.local_angular_velocity);
  if (p.has_orientation) gather(p.row0), gather(p.row1), gather(p.row2);
}

/// Counts the work of a step, at its end. The work of a force is its product with the mean of the velocities at the
/// step's start and end, which is what the grain's kinetic energy gains. Integrators that evaluate where a step ends
/// take the mean of its forces at both ends.
template <class Model>
void count_step(WorldState<Model>& w) {
  grain::EnergyLedger& ledger = w.ledger;
  if constexpr (Model::Domain::has_ranks) gather_motion(w);
  const auto& p = w.grains;
  struct Mean {
    Vector3<double> velocity, angular_velocity;  // m/s, rad/s, global
  };
  std::vector<Mean> grains(p.row_of.size()), bodies;
  const std::size_t known = ledger.velocity.size();
  ledger.velocity.resize(p.row_of.size());
  ledger.global_angular_velocity.resize(p.row_of.size());
  ledger.energy.resize(p.row_of.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t id = 0; id < known; ++id) {
    grains[id] = {ledger.velocity[id], ledger.global_angular_velocity[id]};
    if (p.row_of[id] != p.gone || std::isnan(ledger.energy[id])) continue;
    ledger.came -= ledger.energy[id];
    ledger.energy[id] = std::numeric_limits<double>::quiet_NaN();
  }
  for (std::size_t row = 0; row < p.count; ++row) {
    const std::uint32_t id = p.id[row];
    const Vector3<double> v = p.velocity[row], s = p.angular_velocity(row);
    // The velocities of an id that is given again are those of another grain.
    const bool is_known = id < known && (p.row_of[id] == p.gone || !std::isnan(ledger.energy[id]));
    grains[id] =
        is_known ? Mean{0.5 * (ledger.velocity[id] + v), 0.5 * (ledger.global_angular_velocity[id] + s)} : Mean{v, s};
    ledger.velocity[id] = v;
    ledger.global_angular_velocity[id] = s;
    if (p.row_of[id] == p.gone) continue;
    const GrainEnergy e = energy_of_row(w, row);
    const double sum = e.kinetic() + e.potential;
    if (std::isnan(ledger.energy[id])) ledger.came += sum;
    ledger.energy[id] = sum;
  }
  ledger.body_velocity.resize(w.machine.bodies().size());
  ledger.body_angular_velocity.resize(w.machine.bodies().size());
  for (std::size_t b = 0; b < w.machine.bodies().size(); ++b) {
    const auto& m = w.machine.bodies()[b].motion;
    const Vector3<double> turning = m.rotation * m.angular_velocity;
    bodies.push_back({0.5 * (ledger.body_velocity[b] + m.velocity), 0.5 * (ledger.body_angular_velocity[b] + turning)});
    ledger.body_velocity[b] = m.velocity;
    ledger.body_angular_velocity[b] = turning;
  }

  const auto is_held = [&](std::uint32_t id) {
    const std::uint32_t row = p.row_of[id];
    return row != p.gone && w.species[p.species[row]].is_held();
  };
  const auto add = [&](const grain::ContactWork& c, double time) {
    const Mean& i = grains[c.i];
    const Mean& j = c.on_surface ? bodies[w.surfaces[c.partner].body.index()] : grains[c.partner];
    const Vector3<double> at_i = i.velocity + cross(i.angular_velocity, c.arm),
                          at_j = j.velocity + cross(j.angular_velocity, c.other_arm);
    const Vector3<double> velocity = at_i - at_j;
    const double push = dot(c.force, c.normal), along = push * dot(c.normal, velocity);
    ledger.into_contacts.normal -= time * along;
    ledger.into_contacts.friction -= time * (dot(c.force, velocity) - along);
    ledger.into_contacts.rolling -= time * dot(c.moment, i.angular_velocity - j.angular_velocity);
    if (is_held(c.i)) ledger.by_surfaces -= time * (dot(c.force, at_i) + dot(c.moment, i.angular_velocity));
    if (c.on_surface || is_held(c.partner))
      ledger.by_surfaces += time * (dot(c.force, at_j) + dot(c.moment, j.angular_velocity));
  };
  constexpr bool at_end = evaluates_at_end<typename Model::Integrator>;
  const double dt = w.time_step, share = at_end ? 0.5 : 1.0;
  if (at_end) {
    for (const grain::ContactWork& c : ledger.last) add(c, 0.5 * dt);
  }
  ledger.last.clear();
  append_contacts(w, ledger.last);
  for (const grain::ContactWork& c : ledger.last) add(c, share * dt);
  if (!at_end) ledger.last.clear();
}

}  // namespace detail

/// The energies of the grains as they stand, and what was dissipated since count_energy(). Springs count where their
/// laws tell what they store (their optional function `energy`): the work on others counts as dissipated. Contacts of
/// machine parts with each other are not the grains'. The world is not changed; it costs what contacts_of() does. Where
/// ranks share the grains, all ranks call it at once.
template <class Model>
GrainEnergy energy_of(const World<Model>& world) {
  const WorldState<Model>& w = world.state();
  if constexpr (Model::Domain::has_ranks) {
    if (!w.domain.is_whole) {  // within a run: a copy gets to know all grains
      check_agreement(w, domain::Call::contacts);
      World<Model> copy = world;
      gather_rows(copy.state());
      return energy_of(copy);
    }
  }
  GrainEnergy e;
  for (std::size_t row = 0; row < w.grains.count; ++row) {
    if (w.grains.row_of[w.grains.id[row]] == w.grains.gone) continue;
    const GrainEnergy one = detail::energy_of_row(w, row);
    e.translation += one.translation;
    e.rotation += one.rotation;
    e.potential += one.potential;
  }
  for (const auto& c : contacts_of(world)) {
    if (c.kind != ContactKind::bodies) detail::add_stored(c, w.materials.table()[c.law], e);
  }
  const grain::EnergyLedger& ledger = w.ledger;
  if (!ledger.on) return e;
  const auto &in = ledger.into_contacts, &start = ledger.stored;
  e.dissipated_normal = in.normal - (e.normal_springs + e.cohesion - start.normal);
  e.dissipated_friction = in.friction - (e.friction_springs - start.friction);
  e.dissipated_rolling = in.rolling - (e.rolling_springs - start.rolling);
  e.dissipated_asleep = ledger.stopped;
  e.by_surfaces = ledger.by_surfaces;
  e.came = ledger.came;
  return e;
}

/// Counts from now on, while the world runs, what contacts dissipate and what machine parts do on the grains; energy_of
/// tells it. What a contact dissipates is the work that went into it, less what its springs store. The run itself is
/// the same bits as without; the work is added up on one thread after each step. Changes by hand (set_velocity,
/// set_position, set_contact) are not counted: call it again after them. Throws Error as prepare() does. Where ranks
/// share the grains, all ranks call it at once, between runs. In each step they are then told how all grains move and
/// all contacts, and each rank adds up all of them.
///
///     count_energy(world);
///     world.run_for(1.0);
///     const GrainEnergy e = energy_of(world);   // e.balance() is what it was
template <class Model>
void count_energy(World<Model>& world) {
  if constexpr (domain::IsSheared<typename Model::Domain>) {
    fail("count_energy does not know the work that shears a cell; count it by the stress times the shear rate");
  }
  require_between_runs(world.state(), "that energy is counted");
  world.prepare();
  WorldState<Model>& w = world.state();
  w.ledger = {};
  const GrainEnergy e = energy_of(world);
  grain::EnergyLedger& ledger = w.ledger;
  ledger.on = true;
  ledger.stored = {e.normal_springs + e.cohesion, e.friction_springs, e.rolling_springs};
  for (const auto& c : contacts_of(world)) {
    if (c.kind == ContactKind::bodies) continue;
    const bool on_surface = c.kind == ContactKind::grain_on_surface;
    ledger.last.push_back({c.grain.slot, on_surface ? c.surface.value : c.other_grain.slot, on_surface,
                           from_eigen(c.normal), from_eigen(c.arm), from_eigen(c.other_arm), from_eigen(c.force),
                           from_eigen(c.rolling_torque())});
  }
  const auto& p = w.grains;
  ledger.velocity.resize(p.row_of.size());
  ledger.global_angular_velocity.resize(p.row_of.size());
  ledger.energy.resize(p.row_of.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t row = 0; row < p.count; ++row) {
    const std::uint32_t id = p.id[row];
    ledger.velocity[id] = p.velocity[row];
    ledger.global_angular_velocity[id] = p.angular_velocity(row);
    if (p.row_of[id] == p.gone) continue;
    const GrainEnergy one = detail::energy_of_row(w, row);
    ledger.energy[id] = one.kinetic() + one.potential;
  }
  for (const Body& b : w.machine.bodies()) {
    ledger.body_velocity.push_back(b.motion.velocity);
    ledger.body_angular_velocity.push_back(b.motion.rotation * b.motion.angular_velocity);
  }
  w.record_contacts = &detail::record_contacts<Model>;
  w.count_energy = &detail::count_step<Model>;
}

}  // namespace dem
