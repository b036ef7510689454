#pragma once

#include <dem/flat/grains_view.hpp>
#include <dem/flat/pair_kernels.hpp>
#include <dem/flat/surface_kernels.hpp>
#include <dem/grain/chunk.hpp>
#include <dem/math/rotation.hpp>

#include <cstddef>
#include <cstdint>

namespace dem::flat {

/// What the host has to know of all grains after they were moved.
struct Summary {
  double moved2 = 0.0;           ///< m^2, of the farthest since the neighbour list was made
  double overlap = 0.0;          ///< in effective diameters, of the deepest contact
  std::uint32_t not_finite = 0;  ///< grains with a number that is none
  std::uint32_t outside = 0;     ///< grains that left the domain, but for those that were reported
};
DEM_FN Summary merge(const Summary& a, const Summary& b) {
  return {max(a.moved2, b.moved2), max(a.overlap, b.overlap), a.not_finite + b.not_finite, a.outside + b.outside};
}

/// Where grains are expected.
struct DomainView {
  Vector3<double> low, high;       ///< m; infinite where there is no end
  const std::uint8_t* known_lost;  ///< by row: was reported; null if none was
};

/// What depends on where a grain is: what contacts read of it, and what the host has to know.
template <class Model>
DEM_FN Summary refresh_grain(const GrainsView<Model>& grains, const DomainView& domain, std::size_t i,
                             const integrator::Motion<double>& m) {
  const Kind& kind = grains.kind_of(i);
  PartnerView view{m.position, kind.radius, m.velocity, kind.inertia.inverse_mass, m.angular_velocity};
  if constexpr (Model::Shape::has_orientation) {
    view.angular_velocity = m.rotation * m.angular_velocity;
    Pose<typename Model::Shape> pose{};
    grains.shape_of(i).orient(m.rotation, pose.number);
    store_wide(grains.pose + i, pose);
  }
  store_wide(grains.view + i, view);
  const Vector3<double>&x = m.position, &v = m.velocity, &w = m.angular_velocity;
  const Vector3<double> moved = x - grains.vector(GrainsView<Model>::listed_at, i);
  Summary summary;
  summary.moved2 = dot(moved, moved);
  // A NaN or an infinity anywhere survives this sum: 0 * inf = NaN.
  summary.not_finite = 0.0 * (x.x + x.y + x.z + v.x + v.y + v.z + w.x + w.y + w.z) == 0.0 ? 0 : 1;
  const bool inside = x.x >= domain.low.x && x.x <= domain.high.x && x.y >= domain.low.y && x.y <= domain.high.y &&
                      x.z >= domain.low.z && x.z <= domain.high.z;
  if (!inside && (domain.known_lost == nullptr || domain.known_lost[i] == 0)) summary.outside = 1;
  return summary;
}

/// One thread a grain: views and poses of grains that came from the host.
template <class Model>
struct RefreshGrains {
  GrainsView<Model> grains;
  DomainView domain;
  DEM_FN Summary operator()(std::size_t i) const { return refresh_grain(grains, domain, i, grains.motion(i)); }
};

/// One thread a grain: what the integrator does before the forces.
template <class Model>
struct PredictGrains {
  GrainsView<Model> grains;
  DomainView domain;
  int stage;
  double time_step;  ///< s

  DEM_FN Summary operator()(std::size_t i) const {
    auto m = grains.motion(i);
    auto memory = grains.memory_of(i);
    Model::Integrator::template before_forces<double>(stage, time_step, m, memory);
    grains.set_motion(i, m);
    grains.set_memory(i, memory);
    return refresh_grain(grains, domain, i, m);
  }
};

/// The contacts of which a grain is the partner: for each grain, and one more, the first of its candidates.
struct IncomingView {
  const std::uint32_t *first, *candidate;
};

/// One thread a grain: the sum of its contacts, in a fixed order, and the motion that it makes.
template <class Model>
struct MoveGrains {
  GrainsView<Model> grains;
  DomainView domain;
  const std::uint32_t* first_candidate;  ///< of each grain, and one more
  IncomingView incoming;
  const std::uint32_t* first_contact;  ///< of each candidate, and one more
  const ContactResult* of_pairs;
  const std::uint32_t* first_at_surfaces;  ///< of each grain, and one more
  const ContactResult* of_surfaces;
  Vector3<double> gravity;  ///< m/s^2
  int stage;
  double time_step;  ///< s
  bool cleans_rotations;

  DEM_FN Summary operator()(std::size_t i) const {
    Vector3<double> force{0, 0, 0}, torque{0, 0, 0};
    double overlap = 0.0;
    const auto add_own = [&](const ContactResult& r) {
      force += r.force;
      torque += r.torque_i;
      overlap = max(overlap, r.overlap);
    };
    const std::uint32_t end = first_contact[first_candidate[i + 1]];
    for (std::uint32_t c = first_contact[first_candidate[i]]; c < end; ++c) add_own(load_wide(of_pairs + c));
    for (std::uint32_t m = incoming.first[i]; m < incoming.first[i + 1]; ++m) {
      const std::uint32_t k = incoming.candidate[m];
      for (std::uint32_t c = first_contact[k]; c < first_contact[k + 1]; ++c) {
        const ContactResult r = load_wide(of_pairs + c);
        force -= r.force;
        torque += r.torque_j;
      }
    }
    for (std::uint32_t c = first_at_surfaces[i]; c < first_at_surfaces[i + 1]; ++c) add_own(of_surfaces[c]);
    grains.set_vector(ColumnNumbers::force, i, force);
    grains.set_vector(ColumnNumbers::torque, i, torque);

    auto m = grains.motion(i);
    auto memory = grains.memory_of(i);
    Model::Integrator::template after_forces<double>(stage, time_step, m, memory, acceleration(i, m, force, torque));
    if constexpr (Model::Shape::has_orientation) {
      if (cleans_rotations) m.rotation = orthonormalised(m.rotation);
    }
    grains.set_motion(i, m);
    grains.set_memory(i, memory);
    Summary summary = refresh_grain(grains, domain, i, m);
    summary.overlap = overlap;
    return summary;
  }
  /// Eqs. 12 and 13.
  DEM_FN integrator::Acceleration<double> acceleration(std::size_t i, const integrator::Motion<double>& m,
                                                       const Vector3<double>& force, Vector3<double> torque) const {
    const SpeciesInertia& n = grains.kind_of(i).inertia;
    const Vector3<double> moments = {n.inertia[0], n.inertia[1], n.inertia[2]};
    const Vector3<double> inverse = {n.inverse_inertia[0], n.inverse_inertia[1], n.inverse_inertia[2]};
    if constexpr (Model::Shape::has_orientation) torque = transpose_times(m.rotation, torque);
    // As integrator::gyroscopic_lead says.
    const double lead = Model::Integrator::stages == 1 ? 0.5 * time_step : 0.0;
    return {n.inverse_mass * force + n.gravity_scale * gravity,
            integrator::angular_acceleration(torque, m.angular_velocity, moments, inverse, lead)};
  }
};

/// One thread a chunk: its deepest contact in the last evaluation, when the grains come back to the host.
template <class Model>
struct FindDeepest {
  std::size_t grains;
  CandidatesView candidates;
  const std::uint32_t *first_candidate, *first_contact, *candidate_of_contact;
  const ContactResult* of_pairs;
  SurfaceContactsView<Model> at_surfaces;
  const ContactResult* of_surfaces;
  DeepestContact* deepest;

  DEM_FN void operator()(std::size_t chunk) const {
    const std::size_t begin = chunk * chunk_size, end = begin + chunk_size < grains ? begin + chunk_size : grains;
    DeepestContact d{0.0, 0, 0, false};
    for (std::size_t i = begin; i < end; ++i) {
      const auto row = static_cast<std::uint32_t>(i);
      const std::uint32_t pairs_end = first_contact[first_candidate[i + 1]];
      for (std::uint32_t c = first_contact[first_candidate[i]]; c < pairs_end; ++c) {
        if (of_pairs[c].overlap > d.overlap) {
          d = {of_pairs[c].overlap, row, candidates.partner[candidate_of_contact[c]], false};
        }
      }
      for (std::uint32_t c = at_surfaces.first[i]; c < at_surfaces.first[i + 1]; ++c) {
        if (of_surfaces[c].overlap > d.overlap) {
          const auto surface = static_cast<std::uint32_t>(grain::SurfaceKey{at_surfaces.key[c]}.surface());
          d = {of_surfaces[c].overlap, row, surface, true};
        }
      }
    }
    deepest[chunk] = d;
  }
};

}  // namespace dem::flat
