#pragma once

#include <dem/coupling/body_points.hpp>
#include <dem/coupling/follow_turns.hpp>
#include <dem/coupling/near_pairs.hpp>
#include <dem/geometry/contact_shares.hpp>
#include <dem/grain/materials.hpp>

#include <span>
#include <vector>

namespace dem::coupling {

/// Two surfaces of machine parts that may touch each other, and what passed between them in the last force evaluation.
struct BodyPair {
  SurfaceId a, b;
  Vector3<double> force = {0, 0, 0};     ///< N, on the body of a
  Vector3<double> torque_a = {0, 0, 0};  ///< N m, on the body of a about its centre of mass
  Vector3<double> torque_b = {0, 0, 0};  ///< N m, on the body of b about its centre of mass
  int contacts = 0;                      ///< points that touch
  template <class V>
  void fields(V& v) {
    v.given("a", a), v.given("b", b), v("force", force, "N"), v("torque_a", torque_a, "N m");
    v("torque_b", torque_b, "N m"), v("contacts", contacts);
  }
};

/// Key of a contact between bodies: pair in its block, whose point it is, number of the point, feature of the other
/// surface.
struct BodyKey {
  static constexpr std::size_t pairs_of_a_block = 1u << 12, most_pairs = 1u << 24;
  std::uint64_t value = 0;

  static constexpr BodyKey make(std::size_t pair, bool back, std::uint32_t point, std::uint32_t feature) {
    return {std::uint64_t{pair % pairs_of_a_block} << 52 | std::uint64_t{back} << 51 | std::uint64_t{point} << 28 |
            feature};
  }
};

/// Contacts of machine parts with each other and with the ground: their pairs, their histories, and lists for a step.
template <class Model>
struct BodyContacts {
  using Histories = HistoriesOfSteps<history_size<Model>>;

  std::vector<BodyPair> pairs;
  NearPairs broad_phase;
  std::vector<std::uint32_t> near;   ///< pairs whose boxes met in the last force evaluation, ascending; no others push
  std::vector<Histories> histories;  ///< of each block of pairs
  double worst_overlap = 0.0;        ///< in effective diameters, of the last force evaluation
  std::size_t worst_pair = 0;

  std::vector<BodyPoint> points;
  std::vector<grain::Hit> hits;
  std::vector<contact::SurfaceContactPoint<double>> contact_points;
  grain::ContactForces forces;

  /// What contacts remember of this evaluation becomes what the next one starts from.
  void commit() {
    for (Histories& m : histories) m.commit();
  }
};

/// The gap (m) up to which a ball of a pair of surfaces is held by cohesion at a distance, as a grain is; NoGap if the
/// model has no such law. Points are not: check_body_cohesion() refuses pairs without a ball.
template <class Model>
auto body_gap(const ContactParameters<Model>& parameters, double radius) {
  if constexpr (cohesion::reaches<typename Model::Cohesion>) {
    return Model::Cohesion::range(parameters.cohesion, radius);
  } else {
    return shape::NoGap{};
  }
}

/// Tells the broad phase of all pairs; to be called when pairs or constants have changed.
template <class Model, class Surface>
void list_pairs(BodyContacts<Model>& c, std::span<const Surface> surfaces, const Materials<Model>& materials) {
  c.broad_phase.clear(surfaces.size());
  for (std::uint32_t k = 0; k < c.pairs.size(); ++k) {
    const Surface &a = surfaces[c.pairs[k].a.index()], &b = surfaces[c.pairs[k].b.index()];
    const auto& parameters = materials.table()[materials.row(a.material, b.material)];
    const double gap = shape::widened(0.0, body_gap<Model>(parameters, pair_radius(a, b)));
    c.broad_phase.add(c.pairs[k].a.value, c.pairs[k].b.value, k, gap);
  }
  c.broad_phase.finish();
  c.histories.resize((c.pairs.size() + BodyKey::pairs_of_a_block - 1) / BodyKey::pairs_of_a_block);
}

/// A pair whose points are tried, and what its contacts have in common.
struct SampledPair {
  std::size_t pair;
  std::uint32_t law;
  double radius;  ///< m, effective
};

/// Contacts of the points of one surface of a pair with the other surface, up to a gap where cohesion acts at a
/// distance (else NoGap).
template <class Model, class Surface, class Gap>
void sample_body(const SampledPair& at, bool back, const Surface& from, const Surface& onto, const Body& carrier,
                 Gap gap, typename BodyContacts<Model>::Histories& histories, BodyContacts<Model>& c) {
  list_points(from, onto, c.points);
  const Vector3<double> offset = from.origin - carrier.motion.position, start = from.origin - onto.origin;
  const std::size_t first = c.hits.size();
  std::visit(
      [&]<class G>(const G& geometry) {
        for (const BodyPoint& point : c.points) {
          const Vector3<double> place = from.axes * point.place, p = transpose_times(onto.axes, start + place);
          const double reach = shape::widened(point.radius, gap);
          if (!geometry.near(p, reach)) continue;
          geometry.contacts(p, reach, [&](std::uint32_t feature, const Vector3<double>& normal, double distance) {
            c.hits.push_back({BodyKey::make(at.pair, back, point.number, feature).value,
                              static_cast<std::uint32_t>(at.pair), back ? 1u : 0u, at.law});
            c.contact_points.push_back(
                {offset + place, onto.axes * normal, point.radius, distance, at.radius, point.weight});
          });
        }
        if constexpr (history_size < Model >> 0 && surface::NamesDirections<G>) {
          follow_turns(std::span<const grain::Hit>(c.hits).subspan(first), histories.last,
                       [](std::uint64_t) { return true; });
        }
      },
      onto.geometry);
}

/// Makes the contact points of a pair from `first` on one whole contact. Those of `b` with `a` look the other way.
template <class Model>
void fit_pair(std::size_t first, BodyContacts<Model>& c) {
  const auto turn_round = [&] {
    for (std::size_t k = first; k < c.contact_points.size(); ++k) {
      if (c.hits[k].partner != 0) c.contact_points[k].normal = -c.contact_points[k].normal;
    }
  };
  turn_round();
  contact::fit_weights(
      c.contact_points.size() - first, contact::Fit::always,
      [&](std::size_t k) -> contact::SurfaceContactPoint<double>& { return c.contact_points[first + k]; });
  turn_round();
}

/// Finds the contacts of a pair, with the histories of its block.
template <class Model, class Surface>
void sample_pair(std::size_t k, std::span<const Surface> surfaces, const Materials<Model>& materials,
                 std::span<const Body> bodies, typename BodyContacts<Model>::Histories& histories,
                 BodyContacts<Model>& c) {
  const Surface &a = surfaces[c.pairs[k].a.index()], &b = surfaces[c.pairs[k].b.index()];
  const Body &body_a = bodies[a.body.index()], &body_b = bodies[b.body.index()];
  if (!a.active || !b.active || (body_a.fixed && body_b.fixed)) return;
  const SampledPair at = {k, materials.row(a.material, b.material), pair_radius(a, b)};
  const auto gap = body_gap<Model>(materials.table()[at.law], at.radius);
  const double wide = shape::widened(0.0, gap);
  if (!boxes_overlap(a.low, a.high, b.low - filled(wide), b.high + filled(wide))) return;
  const std::size_t first = c.contact_points.size();
  if (!is_ball(b)) sample_body(at, false, a, b, body_a, gap, histories, c);
  if (is_ball(b) || !is_ball(a)) sample_body(at, true, b, a, body_b, gap, histories, c);
  if (!is_ball(a) && !is_ball(b)) fit_pair(first, c);  // each point of a ball is a contact
}

/// The laws for the contacts that were found, and their forces for pairs and bodies.
template <class Model, class Surface>
void load_pairs(std::span<const Surface> surfaces, const Materials<Model>& materials, std::span<Body> bodies, double dt,
                typename BodyContacts<Model>::Histories& histories, BodyContacts<Model>& c) {
  const auto surface_of = [&](std::size_t hit, bool partner) -> const Surface& {
    const BodyPair& pair = c.pairs[c.hits[hit].i];
    return surfaces[((c.hits[hit].partner != 0) != partner ? pair.b : pair.a).index()];
  };
  const auto body_of = [&](std::size_t hit, bool partner) -> Body& {
    return bodies[surface_of(hit, partner).body.index()];
  };
  // Of two bodies that give no way, dampers take the masses that they have.
  const auto view_of = [&](std::size_t hit, bool partner) -> const PartnerView& {
    const Surface &one = surface_of(hit, partner), &other = surface_of(hit, !partner);
    return one.view.inverse_mass + other.view.inverse_mass > 0.0 ? one.view : one.alone;
  };
  grain::ContactEvaluator<Model, contact::SurfaceContactPoint> evaluator(materials.table(), dt);
  const grain::Deepest deepest = evaluator.run(
      c.hits, histories, c.forces, [&](std::size_t k) { return c.contact_points[k]; },
      [&](std::size_t k) -> const PartnerView& { return view_of(k, false); },
      [&](std::size_t k) -> const PartnerView& { return view_of(k, true); });
  if (deepest.overlap > c.worst_overlap) {
    c.worst_overlap = deepest.overlap;
    c.worst_pair = c.hits[deepest.hit].i;
  }

  for (std::size_t k = 0; k < c.hits.size(); ++k) {
    const Vector3<double> force = grain::ContactForces::at(c.forces.force, k);
    const Vector3<double> torque_i = grain::ContactForces::at(c.forces.torque_i, k);
    const Vector3<double> torque_j = grain::ContactForces::at(c.forces.torque_j, k);
    Body &i = body_of(k, false), &j = body_of(k, true);
    i.force += force;
    i.torque += torque_i;
    j.force -= force;
    j.torque += torque_j;
    BodyPair& pair = c.pairs[c.hits[k].i];
    const bool back = c.hits[k].partner != 0;
    pair.force += back ? -force : force;
    pair.torque_a += back ? torque_j : torque_i;
    pair.torque_b += back ? torque_i : torque_j;
    ++pair.contacts;
  }
}

/// Contacts between surfaces of machine parts (thesis section 2.2.4). The points of each surface of a pair are tried
/// against the other surface. Points that push in one direction are weighted so that they are one whole contact. Laws
/// and histories are those of grains. Forces are added to the bodies. Pairs whose bounding boxes do not meet cost
/// nothing. One thread does it in the order of pairs and points, so sums are the same in every run. `look(histories)`
/// is called for each block of pairs while its lists are there.
template <class Model, class Surface, class Look>
void find_body_contacts(BodyContacts<Model>& c, std::span<const Surface> surfaces, const Materials<Model>& materials,
                        std::span<Body> bodies, double dt, Look&& look) {
  if (c.pairs.empty()) return;
  for (const std::uint32_t k : c.near) c.pairs[k] = {c.pairs[k].a, c.pairs[k].b};
  for (auto& histories : c.histories) histories.now.count = 0;
  c.worst_overlap = 0.0;
  c.broad_phase.find(surfaces, c.near);
  for (std::size_t at = 0; at < c.near.size();) {
    const std::size_t block = c.near[at] / BodyKey::pairs_of_a_block;
    c.hits.clear();
    c.contact_points.clear();
    for (; at < c.near.size() && c.near[at] / BodyKey::pairs_of_a_block == block; ++at) {
      sample_pair(c.near[at], surfaces, materials, std::span<const Body>(bodies), c.histories[block], c);
    }
    load_pairs(surfaces, materials, bodies, dt, c.histories[block], c);
    look(c.histories[block]);
  }
}
template <class Model, class Surface>
void find_body_contacts(BodyContacts<Model>& c, std::span<const Surface> surfaces, const Materials<Model>& materials,
                        std::span<Body> bodies, double dt) {
  find_body_contacts(c, surfaces, materials, bodies, dt, [](const auto&) {});
}

}  // namespace dem::coupling
