#pragma once
// Records worlds for the replay of a report.

#include <dem/geometry/mixed.hpp>
#include <dem/io/drawn_body.hpp>
#include <dem/io/drawn_surface.hpp>
#include <dem/io/grain_mesh.hpp>
#include <dem/report/replay_recorder.hpp>
#include <dem/world/contacts.hpp>
#include <dem/world/force_lines.hpp>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace dem::report {

/// The balls of a sphere or cluster.
template <shape::BallShape S>
[[nodiscard]] ReplayShape replay_shape(const S& shape, int = 0) {
  alignas(64) double pose[S::pose_size + 1] = {};
  shape.orient(Matrix3<double>::identity(), pose);
  ReplayShape result;
  for (int k = 0; k < shape::ball_count(shape); ++k) {
    const shape::PosedBall ball = shape::posed_ball(shape, pose, k);
    result.balls.push_back({to_eigen(ball.centre), ball.radius});
  }
  return result;
}

/// The mesh of any other shape, by its grain_mesh(shape, divisions), which own shapes need beside them. Polyhedra,
/// whose faces are polygons, keep their edges; other meshes are shaded round.
template <class S>
[[nodiscard]] ReplayShape replay_shape(const S& shape, int divisions = 6) {
  using io::grain_mesh;
  io::SurfaceMesh mesh = grain_mesh(shape, divisions);
  const double smooth = mesh.polygons.empty() ? std::numbers::pi : 0.0;
  return {.balls = {}, .mesh = std::move(mesh), .smooth_angle = smooth};
}

/// What the kind of a mixed grain looks like.
template <class... Kinds>
[[nodiscard]] ReplayShape replay_shape(const shape::Mixed<Kinds...>& mixed, int divisions = 6) {
  return std::visit([&](const auto& kind) { return replay_shape(kind, divisions); }, mixed.kind());
}

namespace detail {

/// Adds what has come to a world since the last frame: species, surfaces, and bodies that are drawn.
template <class World>
void meet_world(Replay& replay, const World& world, const std::vector<io::DrawnBody>& bodies) {
  Replay::OfWorld& known = replay.of_world();
  const auto& state = world.state();
  const int divisions = world.grain_count() > 5000 ? 4 : 6;  // 192 or 432 triangles for a superquadric
  while (known.species.size() < state.species.size()) {
    known.species.push_back(replay.add_shape(replay_shape(state.species[known.species.size()].shape, divisions)));
  }
  const auto name_of = [&](const std::string& own, BodyId body) {
    return own.empty() ? world.machine().body(body).name : own;
  };
  while (known.surfaces.size() < state.surfaces.size()) {
    const auto& s = state.surfaces[known.surfaces.size()];
    io::SurfaceMesh mesh = io::drawn(s.geometry, replay.options().plane_size);
    known.surfaces.push_back(replay.add_part(name_of(s.name, s.body), std::move(mesh)));
  }
  while (known.bodies.size() < bodies.size()) {
    const io::DrawnBody& d = bodies[known.bodies.size()];
    if (d.mesh == nullptr) fail("replay: drawn body {} has no mesh; set DrawnBody::mesh", known.bodies.size());
    known.bodies.push_back(replay.add_part(name_of("", d.body), *d.mesh));
  }
}

/// The force chains of a world whose grains are all somewhere; none of one that has blown up, which has no neighbours.
template <class World>
std::vector<ReplayForce> replay_forces(const World& world, const std::vector<ReplayGrain>& grains) {
  const auto is_somewhere = [](const ReplayGrain& g) { return g.position.allFinite() && g.rotation.allFinite(); };
  if (!std::all_of(grains.begin(), grains.end(), is_somewhere)) return {};
  std::vector<ReplayForce> forces;
  for (const ForceLine& line : force_lines(contacts_of(world))) {
    const bool on_surface = line.surface.valid();
    ReplayForce f{line.grain.index(),
                  on_surface ? line.surface.index() : line.other_grain.index(),
                  on_surface,
                  line.from,
                  line.to,
                  line.force.norm()};
    // A pair keeps its direction, whichever of its grains comes first among the rows.
    if (!on_surface && f.partner < f.grain) std::swap(f.grain, f.partner), std::swap(f.from, f.to);
    forces.push_back(f);
  }
  return forces;
}

}  // namespace detail

/// Replay::record(world, bodies): makes a frame of a world as it is now, if one is due. Grains are drawn by their
/// shapes, coloured by their speeds, the sizes of their net contact forces, or whether they sleep; so are all active
/// surfaces where their bodies are, and besides `bodies` as meshes, the same ones in the same order each time. The
/// largest forces at contacts are kept as force chains, ReplayOptions::force_lines of them, which costs what
/// contacts_of(world) does: where ranks share the grains, all ranks call it at once. Throws dem::Error for a body
/// without a mesh, and as Replay::record and contacts_of do.
template <class World>
bool record_world(Replay& replay, const World& world, const std::vector<io::DrawnBody>& bodies = {}) {
  const double time = world.time();
  if (!replay.due(time)) return replay.pass(time), false;
  detail::meet_world(replay, world, bodies);
  const Replay::OfWorld& known = replay.of_world();
  std::vector<ReplayGrain> grains;
  grains.reserve(world.grain_count());
  for (const GrainId p : world.grains()) {
    grains.push_back({p.index(), known.species[world.species_of(p).index()], world.position(p), world.rotation(p),
                      world.velocity(p).norm(), world.force(p).norm(), world.is_asleep(p)});
  }
  std::vector<ReplayPose> poses(replay.parts().size(), {.shown = false});
  const auto& machine = world.machine();
  const auto& surfaces = world.state().surfaces;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const auto& s = surfaces[k];
    const auto& b = machine.body(s.body);
    poses[known.surfaces[k]] = {b.point(s.position), b.rotation() * s.rotation, s.active};
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const io::DrawnBody& d = bodies[k];
    poses[known.bodies[k]] = {machine.reference_point(d.body, d.position),
                              machine.reference_rotation(d.body) * d.rotation, true};
  }
  std::vector<ReplayForce> forces;
  if (replay.options().force_lines > 0) forces = detail::replay_forces(world, grains);
  return replay.record(time, grains, poses, forces);
}

}  // namespace dem::report
