#pragma once

#include <dem/pipeline/contact_evaluator.hpp>
#include <dem/pipeline/stable_time_step.hpp>
#include <dem/state/machine_surface.hpp>

#include <span>
#include <vector>

namespace dem::pipeline {

/// Two surfaces of machine parts that may touch each other, and what passed between them in the last force evaluation.
struct BodyPair {
  SurfaceId a, b;
  Vector3<double> force = {0, 0, 0};     ///< N, on the body of a
  Vector3<double> torque_a = {0, 0, 0};  ///< N m, on the body of a about its centre of mass
  Vector3<double> torque_b = {0, 0, 0};  ///< N m, on the body of b about its centre of mass
  int contacts = 0;                      ///< points that touch
};

/// Key of a contact between bodies: pair, whose point it is, number of the point, feature of the other surface.
struct BodyKey {
  static constexpr std::size_t most_pairs = 1u << 12;
  static constexpr std::uint64_t make(std::size_t pair, bool back, std::uint32_t point, std::uint32_t feature) {
    return std::uint64_t{pair} << 52 | std::uint64_t{back} << 51 | std::uint64_t{point} << 28 | feature;
  }
};

/// Contacts of machine parts with each other and with the ground: their pairs, their memories, and lists for a step.
template <class Model>
struct BodyContacts {
  std::vector<BodyPair> pairs;
  ContactMemories<history_size<Model>> memories;
  double worst_overlap = 0.0;  ///< in effective diameters, of the last force evaluation
  std::size_t worst_pair = 0;

  struct Point {
    std::uint32_t number;
    Vector3<double> place;  ///< m, from the centre of its body, global axes
    double radius, effective_radius;
  };
  std::vector<Point> points;
  std::vector<Hit> hits;
  std::vector<contact::SurfaceTouch<double>> touches;
  ContactForces forces;
};

/// A surface whose points cover it: two such surfaces (or one and a plane) find each other by their points.
template <class S>
concept HasPoints = requires(const S& s, const surface::Bounds& box) {
  s.points(box, [](std::uint32_t, const Vector3<double>&, double) {});
  { s.points_at_once() } -> std::convertible_to<std::size_t>;
};
/// A surface that may be one ball: its probe finds every contact, so the partner's points are not needed.
template <class S>
concept MayBeBall = requires(const S& s) {
  { s.is_ball() } -> std::same_as<bool>;
};

template <class Surface>
bool is_ball(const Surface& s) {
  return std::visit(
      []<class G>(const G& g) {
        if constexpr (MayBeBall<G>) return g.is_ball();
        return false;
      },
      s.geometry);
}
/// Points of a surface that may touch a plane at once.
template <class Surface>
std::size_t points_at_once(const Surface& s) {
  return std::visit(
      []<class G>(const G& g) -> std::size_t {
        if constexpr (HasPoints<G>) return g.points_at_once();
        return 0;
      },
      s.geometry);
}
/// The scale on which a surface is round, for laws that ask for a radius (m): half its smaller extent.
template <class Surface>
double point_radius(const Surface& s) {
  const surface::Bounds b = std::visit([](const auto& g) { return g.bounds(); }, s.geometry);
  const Vec3 extent = b.high - b.low;
  double smallest = extent.maxCoeff();
  for (int k = 0; k < 3; ++k) {
    if (extent[k] > 1e-6 * extent.maxCoeff()) smallest = std::min(smallest, extent[k]);
  }
  return 0.5 * smallest;
}

/// The points of `from` in the box that both surfaces' boxes share.
template <class Model, class Surface>
void list_points(const Surface& from, const Surface& onto, const Body& carrier, BodyContacts<Model>& c) {
  c.points.clear();
  const Vec3 low = from.low.cwiseMax(onto.low), high = from.high.cwiseMin(onto.high);
  const Mat3 axes = to_eigen(from.axes);
  const Vec3 centre = axes.transpose() * (0.5 * (low + high) - to_eigen(from.origin));
  const Vec3 half = axes.cwiseAbs().transpose() * (0.5 * (high - low));
  const double slack = 1e-9 * half.maxCoeff();  // for rounding
  const surface::Bounds box = {centre.array() - half.array() - slack, centre.array() + half.array() + slack};
  const Vector3<double> offset = from.origin - carrier.motion.position;
  std::visit(
      [&]<class G>(const G& geometry) {
        if constexpr (HasPoints<G>) {
          const double round = point_radius(from);
          geometry.points(box, [&](std::uint32_t number, const Vector3<double>& p, double radius) {
            c.points.push_back({number, offset + from.axes * p, radius, radius > 0.0 ? radius : round});
          });
        }
      },
      from.geometry);
}

/// Contacts of the points of one surface of a pair with the other surface.
template <class Model, class Surface>
void probe_body(std::size_t pair, bool back, const Surface& from, const Surface& onto, const Body& carrier,
                std::uint32_t law, BodyContacts<Model>& c) {
  list_points(from, onto, carrier, c);
  const Vector3<double> start = carrier.motion.position - onto.origin;
  std::visit(
      [&](const auto& geometry) {
        for (const auto& point : c.points) {
          const Vector3<double> p = transpose_times(onto.axes, start + point.place);
          if (!geometry.near(p, point.radius)) continue;
          geometry.touch(p, point.radius, [&](std::uint32_t feature, const Vector3<double>& normal, double gap) {
            c.hits.push_back({BodyKey::make(pair, back, point.number, feature), static_cast<std::uint32_t>(pair),
                              back ? 1u : 0u, law});
            c.touches.push_back({point.place, onto.axes * normal, point.radius, gap,
                                 surface::radius_on(geometry, point.effective_radius), 1.0});
          });
        }
      },
      onto.geometry);
}

/// Contacts between surfaces of machine parts, thesis section 2.2.4: the points of each surface of a pair against the
/// other surface, with the laws and memories of grains; adds the forces to the bodies. Pairs whose bounding boxes do
/// not meet cost nothing more. One thread does it in the order of pairs and points: the same sums in every run.
template <class Model, class Surface>
void find_body_contacts(BodyContacts<Model>& c, std::span<const Surface> surfaces, const Materials<Model>& materials,
                        std::span<Body> bodies, double dt) {
  if (c.pairs.empty()) return;
  c.hits.clear();
  c.touches.clear();
  for (std::size_t k = 0; k < c.pairs.size(); ++k) {
    BodyPair& pair = c.pairs[k];
    pair.force = pair.torque_a = pair.torque_b = {0, 0, 0};
    pair.contacts = 0;
    const Surface &a = surfaces[pair.a.index()], &b = surfaces[pair.b.index()];
    const Body &body_a = bodies[a.body.index()], &body_b = bodies[b.body.index()];
    if (!a.active || !b.active || (body_a.fixed && body_b.fixed)) continue;
    if ((a.low.array() > b.high.array()).any() || (b.low.array() > a.high.array()).any()) continue;
    const std::uint32_t law = materials.row(a.material, b.material);
    if (!is_ball(b)) probe_body(k, false, a, b, body_a, law, c);
    if (is_ball(b) || !is_ball(a)) probe_body(k, true, b, a, body_b, law, c);
  }

  const auto surface_of = [&](std::size_t hit, bool partner) -> const Surface& {
    const BodyPair& pair = c.pairs[c.hits[hit].i];
    return surfaces[((c.hits[hit].partner != 0) != partner ? pair.b : pair.a).index()];
  };
  const auto body_of = [&](std::size_t hit, bool partner) -> Body& {
    return bodies[surface_of(hit, partner).body.index()];
  };
  ContactEvaluator<Model, contact::SurfaceTouch> evaluator(materials.table(), dt);
  const Deepest deepest = evaluator.run(
      c.hits, c.memories, c.forces, [&](std::size_t k) { return c.touches[k]; },
      [&](std::size_t k) -> const PartnerView& { return surface_of(k, false).view; },
      [&](std::size_t k) -> const PartnerView& { return surface_of(k, true).view; });
  c.worst_overlap = deepest.overlap;
  if (deepest.overlap > 0.0) c.worst_pair = c.hits[deepest.hit].i;

  for (std::size_t k = 0; k < c.hits.size(); ++k) {
    const Vector3<double> force = ContactForces::at(c.forces.force, k);
    const Vector3<double> torque_i = ContactForces::at(c.forces.torque_i, k);
    const Vector3<double> torque_j = ContactForces::at(c.forces.torque_j, k);
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

/// From the centre of mass of a surface's body to the farthest corner of the surface's box, m.
template <class Surface>
double reach_of(const Surface& s) {
  const surface::Bounds b = std::visit([](const auto& g) { return g.bounds(); }, s.geometry);
  double farthest = 0.0;
  for (unsigned k = 0; k < 8; ++k) {
    const Vec3 corner(k & 1 ? b.high.x() : b.low.x(), k & 2 ? b.high.y() : b.low.y(), k & 4 ? b.high.z() : b.low.z());
    farthest = std::max(farthest, (s.position + s.rotation * corner).norm());
  }
  return farthest;
}
/// How little a body resists at the farthest point of its surface, 1/m + R^2/I (1/kg); 0 for a fixed one. An endless
/// surface is touched at `lever` (m).
template <class Surface>
double softness_of(const Surface& s, const Body& body, double lever) {
  if (body.fixed) return 0.0;
  if (const double reach = reach_of(s); reach < 1e100) lever = reach;
  return 1.0 / body.mass + lever * lever / body.inertia.minCoeff();
}

/// Largest stable time step of the contacts between bodies: all points that may touch a plane at once are taken to act
/// at the farthest point of the surface from the centre of mass, in line:
///   W = 1/m_a + 1/m_b + R_a^2/I_a + R_b^2/I_b in stable_step()
template <class Model, class Surface>
StableTimeStep stable_time_step_of_bodies(std::span<const BodyPair> pairs, std::span<const Surface> surfaces,
                                          std::span<const Body> bodies, const Materials<Model>& materials,
                                          double overlap_limit) {
  StableTimeStep result;
  for (const BodyPair& pair : pairs) {
    const Surface &a = surfaces[pair.a.index()], &b = surfaces[pair.b.index()];
    const Body &body_a = bodies[a.body.index()], &body_b = bodies[b.body.index()];
    // An endless surface is touched where its partner is.
    const double smaller = std::min(reach_of(a), reach_of(b));
    const double soft = softness_of(a, body_a, smaller) + softness_of(b, body_b, smaller);
    if (!(soft > 0.0)) continue;
    const double inverse_mass = (body_a.fixed ? 0.0 : 1.0 / body_a.mass) + (body_b.fixed ? 0.0 : 1.0 / body_b.mass);
    const double n = is_ball(a) || is_ball(b) ? 1.0 : static_cast<double>(points_at_once(a) + points_at_once(b));
    const double radius = std::min(point_radius(a), point_radius(b));
    const auto& parameters = materials.table()[materials.row(a.material, b.material)];
    const contact::NormalState<double> deepest = {2.0 * overlap_limit * radius, 0.0, radius, 1.0 / inverse_mass, 0.0};
    const auto limit_by = [&](double k, double c) {
      const double dt = stable_step(Model::Integrator::stability_limit, n * k, n * c, soft);
      if (!(dt < result.value)) return;
      result = {dt, fmt::format("body '{}' on body '{}': {:g} contact points of {:g} N/m each", body_a.name,
                                body_b.name, n, k)};
    };
    limit_by(
        Model::Normal::stiffness(parameters.normal, deepest) + Model::Cohesion::stiffness(parameters.cohesion, deepest),
        contact::damping_of<typename Model::Normal>(parameters.normal, deepest));
    limit_by(friction::stiffness_of<typename Model::Friction>(parameters.friction, deepest),
             contact::damping_of<typename Model::Friction>(parameters.friction, deepest));
  }
  return result;
}

}  // namespace dem::pipeline
