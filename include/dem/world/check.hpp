#pragma once

#include <dem/world/report.hpp>
#include <dem/world/state.hpp>

namespace dem {

/// The grain of a chunk with the largest contact force: where the deepest overlap is.
template <class Model>
std::size_t most_loaded(const WorldState<Model>& w, std::size_t chunk) {
  const std::size_t begin = chunk * chunk_size, end = std::min(begin + chunk_size, w.particles.count);
  std::size_t worst = begin;
  for (std::size_t i = begin; i < end; ++i) {
    if (norm(w.particles.force[i]) > norm(w.particles.force[worst])) worst = i;
  }
  return worst;
}

/// Looks for grains that are not finite, lost, or pressed too deep into something. Costs a look at each chunk; only
/// when something is wrong the grain is searched.
template <class Model>
StepReport find_problem(const WorldState<Model>& w) {
  const auto& p = w.particles;
  const auto problem = [&](StepReport::Problem kind, std::size_t row, std::string text) {
    return StepReport{kind, w.time, w.step, row < p.count ? ParticleId(p.id[row]) : ParticleId{}, std::move(text)};
  };
  const auto when = [&] { return fmt::format("at t = {:.6g} s (step {})", w.time, w.step); };
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    const auto& chunk = w.chunks[c];
    const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, p.count);
    if (!chunk.finite) [[unlikely]] {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 all = to_eigen(p.position[i]) + to_eigen(p.velocity[i]) + to_eigen(p.spin[i]);
        if (all.allFinite()) continue;
        return problem(
            StepReport::Problem::not_finite, i,
            fmt::format("grain {} has a position or velocity that is not a number {}: the simulation blew up; "
                        "lower time_step (now {:g} s) or the stiffness, or raise the damping",
                        p.id[i], when(), w.time_step));
      }
    }
    if (const auto& domain = w.options.domain; domain && ((chunk.low.array() < domain->low.array()).any() ||
                                                          (chunk.high.array() > domain->high.array()).any()))
        [[unlikely]] {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 x = to_eigen(p.position[i]);
        if ((x.array() >= domain->low.array()).all() && (x.array() <= domain->high.array()).all()) continue;
        return problem(
            StepReport::Problem::lost, i,
            fmt::format("grain {} left the domain {} and is at ({:.4g}, {:.4g}, {:.4g}) m; close the walls, lower "
                        "time_step (now {:g} s), or enlarge domain",
                        p.id[i], when(), x.x(), x.y(), x.z(), w.time_step));
      }
    }
    if (chunk.worst_overlap > w.options.overlap_limit) [[unlikely]] {
      const std::size_t i = most_loaded(w, c);
      return problem(
          StepReport::Problem::overlap, i,
          fmt::format("grain {} overlaps its partner by {:.3g} of their effective diameter {}, more than "
                      "overlap_limit {:g}; raise the normal stiffness, lower time_step (now {:g} s) or the load, "
                      "or start from a looser packing",
                      p.id[i], chunk.worst_overlap, when(), w.options.overlap_limit, w.time_step));
    }
  }
  if (w.body_contacts.worst_overlap > w.options.overlap_limit) [[unlikely]] {
    const pipeline::BodyPair& pair = w.body_contacts.pairs[w.body_contacts.worst_pair];
    const auto body = [&](SurfaceId s) { return w.machine.bodies()[w.surfaces[s.index()].body.index()].name; };
    return problem(
        StepReport::Problem::overlap, p.count,
        fmt::format("body '{}' overlaps body '{}' by {:.3g} of their effective diameter {}, more than "
                    "overlap_limit {:g}; raise the normal stiffness between their materials, lower time_step "
                    "(now {:g} s), or start with the bodies apart",
                    body(pair.a), body(pair.b), w.body_contacts.worst_overlap, when(), w.options.overlap_limit,
                    w.time_step));
  }
  if (const auto report = w.machine.report(); !report) {
    return problem(StepReport::Problem::machine, p.count, report.text);
  }
  return {StepReport::Problem::none, w.time, w.step, {}, {}};
}

}  // namespace dem
