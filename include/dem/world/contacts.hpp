#pragma once

#include <dem/world/complete.hpp>
#include <dem/world/contact.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <cstring>
#include <vector>

namespace dem {

namespace detail {

/// A contact's history from the columns of histories.
template <class Model>
ContactHistory<Model, double> history_at(const ContactHistories<history_size<Model>>& histories, std::size_t c) {
  ContactHistory<Model, double> history{};
  std::size_t row = 0;
  const auto read = [&](auto& of_law) {
    using History = std::remove_reference_t<decltype(of_law)>;
    if constexpr (!std::is_empty_v<History>) {
      std::array<double, sizeof(History) / sizeof(double)> fields;
      for (double& field : fields) field = histories.history[row++][c];
      std::memcpy(static_cast<void*>(&of_law), fields.data(), sizeof(of_law));
    }
  };
  read(history.normal), read(history.friction), read(history.rolling), read(history.cohesion);
  return history;
}

/// The contacts of a state, found as a step finds them, but on copies of all that a step writes to.
template <class Model>
class ContactFinder {
 public:
  explicit ContactFinder(const WorldState<Model>& w) : w_(w), surfaces_(w.surfaces) {
    const mbd::CarriedBodies carried(w.machine.parts());
    for (auto& s : surfaces_) s.follow(w.machine.bodies()[s.body.index()], !carried.has(s.body));
  }

  std::vector<Contact<Model>> find() {
    for (std::size_t c = 0; c < w_.chunks.size(); ++c) find_of_chunk(c);
    if (!w_.body_contacts.pairs.empty()) find_of_bodies();
    return std::move(contacts_);
  }

 private:
  using Surface = typename WorldState<Model>::Surface;
  using Histories = HistoriesOfSteps<history_size<Model>>;

  void find_of_chunk(std::size_t c) {
    Chunk<Model> chunk = w_.chunks[c];
    const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, w_.grains.count);
    const auto& p = w_.grains;
    grain::ForceSums sums;
    const grain::ChunkPairs<Model, std::remove_cvref_t<decltype(p)>> pairs{chunk, p, w_.species, w_.materials, begin};
    grain::find_pair_contacts(pairs, w_.time_step, {}, sums, scratch_.pairs);
    for (std::size_t k = 0; k < scratch_.pairs.hits.size(); ++k) {
      const grain::Hit& hit = scratch_.pairs.hits[k];
      const auto geometry = grain::contact_point_of_hit<Model>(pairs, scratch_.pairs, k).geometry();
      Contact<Model>& contact = add(hit, geometry, p.view[hit.i], p.view[hit.partner], scratch_.pairs.forces, k);
      contact.kind = ContactKind::grains;
      contact.grain = p.name(p.id[hit.i]);
      contact.other_grain = p.name(p.id[hit.partner]);
      remember(contact, chunk.pair_contacts, hit.key, k);
    }
    coupling::SurfaceScratch& s = scratch_.surfaces;
    coupling::find_surface_contacts<Model>(
        {begin, end, chunk, p, w_.species, w_.materials, surfaces_, w_.largest_radius, w_.domain, s}, w_.find_hits,
        w_.time_step, sums);
    for (std::size_t k = 0; k < s.hits.size(); ++k) {
      const grain::Hit& hit = s.hits[k];
      Contact<Model>& contact = add(hit, s.contact_points[k].geometry(), coupling::view_of<Model>(s, k, p),
                                    surfaces_[hit.partner].view, s.forces, k);
      contact.kind = ContactKind::grain_on_surface;
      contact.grain = p.name(p.id[hit.i]);
      contact.surface = SurfaceId(hit.partner);
      remember(contact, chunk.surface_contacts, hit.key, k);
    }
  }

  void find_of_bodies() {
    coupling::BodyContacts<Model> found = w_.body_contacts;
    std::vector<Body> bodies = w_.machine.bodies();
    coupling::find_body_contacts<Model>(
        found, std::span<const Surface>(surfaces_), w_.materials, std::span(bodies), w_.time_step,
        [&](Histories& histories) {
          for (std::size_t k = 0; k < found.hits.size(); ++k) {
            const grain::Hit& hit = found.hits[k];
            const coupling::BodyPair& pair = found.pairs[hit.i];
            const bool back = hit.partner != 0;
            const SurfaceId own = back ? pair.b : pair.a, other = back ? pair.a : pair.b;
            Contact<Model>& contact = add(hit, found.contact_points[k].geometry(), surfaces_[own.index()].view,
                                          surfaces_[other.index()].view, found.forces, k);
            contact.kind = ContactKind::bodies;
            contact.own_surface = own;
            contact.surface = other;
            contact.pair = BodyContactId(hit.i);
            remember(contact, histories, hit.key, k);
          }
        });
  }

  Contact<Model>& add(const grain::Hit& hit, const contact::Geometry<double>& g, const PartnerView& i,
                      const PartnerView& j, const grain::ContactForces& forces, std::size_t k) {
    Contact<Model>& c = contacts_.emplace_back();
    c.law = hit.law;
    c.point_key = hit.key;
    c.point = to_eigen(i.position + g.arm);
    c.normal = to_eigen(g.normal);
    c.overlap = g.overlap;
    c.effective_radius = g.effective_radius;
    c.weight = g.weight;
    c.arm = to_eigen(g.arm);
    c.other_arm = to_eigen(g.arm - (j.position - i.position));
    c.force = to_eigen(grain::ContactForces::at(forces.force, k));
    c.torque = to_eigen(grain::ContactForces::at(forces.torque_i, k));
    c.other_torque = to_eigen(grain::ContactForces::at(forces.torque_j, k));
    return c;
  }
  void remember(Contact<Model>& c, const Histories& histories, std::uint64_t key, std::size_t k) const {
    c.history = history_at<Model>(histories.now, k);
    const auto begin = histories.last.key.begin(), end = begin + histories.last.count;
    const auto at = std::lower_bound(begin, end, key);
    c.last = {};
    if (at != end && *at == key) c.last = history_at<Model>(histories.last, static_cast<std::size_t>(at - begin));
  }

  const WorldState<Model>& w_;
  std::vector<Surface> surfaces_;
  ContactScratch<Model> scratch_;
  std::vector<Contact<Model>> contacts_;
};

}  // namespace detail

/// All contact points of a world as it stands: of grains with each other, of grains with surfaces, and of machine parts
/// with each other; in the order of the rows of grains, which is the same for any number of threads. The world is not
/// changed, and runs on as if it had not been asked.
///
/// The forces are those of a force evaluation at the present state, with which the next step begins. World::force tells
/// the last evaluation, which was before the grains moved. (Velocity Verlet moves the grains on before it evaluates.) A
/// grain that an outlet took is felt, and listed, until its row goes.
///
/// In a periodic cell, a contact across a border is with an image: `other_grain` is the grain that it shows, the places
/// are those of the image.
///
/// Where ranks share the grains, all ranks call it at once, and each gets all contacts.
///
/// It costs about one evaluation on one thread, and a copy of the world where it was changed by hand or its neighbour
/// lists are due, or where it has a periodic cell or is shared by ranks. Throws Error as World::prepare does.
template <class Model>
std::vector<Contact<Model>> contacts_of(const World<Model>& world) {
  require_grains_here(world.state(), "what touches what");
  constexpr bool copies = Model::Domain::has_images || Model::Domain::has_ranks;
  if (!copies && world.is_prepared() && !neighbours_outdated(world.state())) {
    return detail::ContactFinder<Model>(world.state()).find();
  }
  if constexpr (Model::Domain::has_ranks) check_agreement(world.state(), domain::Call::contacts);
  World<Model> copy = world;
  copy.prepare();
  if (neighbours_outdated(copy.state())) rebuild_neighbours(copy.state());
  if constexpr (Model::Domain::has_ranks) complete_chunks(copy.state());
  place_images(copy.state());
  return detail::ContactFinder<Model>(copy.state()).find();
}

}  // namespace dem
