#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace dem::mbd {

/// The machines that the parts make up: the free bodies that joints and springs connect. Fixed bodies connect nothing,
/// and a free joint holds nothing.
struct JoinedBodies {
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Machine {
    double mass = 0.0;  ///< kg, of all its bodies
    /// m, diagonal of the box about its joints' points and its bodies, each as far as its radius of gyration reaches.
    double size = 0.0;
  };
  std::vector<std::uint32_t> machine_of;  ///< of each body; `none` of a fixed one
  std::vector<Machine> machines;

  /// That of a joint; `none` if both its bodies are fixed.
  std::uint32_t machine_of_joint(const Joint& j) const { return std::min(machine_of[j.a], machine_of[j.b]); }
};

JoinedBodies joined_bodies(const Parts& m);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE JoinedBodies joined_bodies(const Parts& m) {
  using V = Vector3<double>;
  const std::size_t n = m.bodies.size();
  std::vector<std::uint32_t> root(n);
  for (std::size_t i = 0; i < n; ++i) root[i] = static_cast<std::uint32_t>(i);
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const auto connect = [&](std::uint32_t a, std::uint32_t b) {
    if (m.bodies[a].fixed || m.bodies[b].fixed) return;
    const std::uint32_t ra = find(a), rb = find(b);
    root[std::max(ra, rb)] = std::min(ra, rb);
  };
  for (const Joint& j : m.joints) {
    if (traits_of(j.kind).stiffness != Stiffness::none) connect(j.a, j.b);
  }
  for (const Spring& s : m.springs) connect(s.a, s.b);

  JoinedBodies all;
  all.machine_of.assign(n, JoinedBodies::none);
  std::vector<V> low, high;
  const auto reach = [&](std::uint32_t k, const V& p) {
    low[k] = {std::min(low[k].x, p.x), std::min(low[k].y, p.y), std::min(low[k].z, p.z)};
    high[k] = {std::max(high[k].x, p.x), std::max(high[k].y, p.y), std::max(high[k].z, p.z)};
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Body& b = m.bodies[i];
    if (b.fixed) continue;
    const std::uint32_t r = find(static_cast<std::uint32_t>(i));  // the first of its bodies, so it is listed already
    if (r == i) {
      all.machine_of[i] = static_cast<std::uint32_t>(all.machines.size());
      all.machines.push_back({});
      low.push_back(b.motion.position);
      high.push_back(b.motion.position);
    }
    const std::uint32_t k = all.machine_of[i] = all.machine_of[r];
    all.machines[k].mass += b.mass;
    const double largest = std::max({b.inertia[0], b.inertia[1], b.inertia[2]});
    const double gyration = std::sqrt(largest / b.mass);
    reach(k, b.motion.position + V{gyration, gyration, gyration});
    reach(k, b.motion.position - V{gyration, gyration, gyration});
  }
  for (const Joint& j : m.joints) {
    const std::uint32_t k = all.machine_of_joint(j);
    if (k == JoinedBodies::none || traits_of(j.kind).stiffness == Stiffness::none) continue;
    const integrator::Motion<double>&a = m.bodies[j.a].motion, &b = m.bodies[j.b].motion;
    reach(k, a.position + a.rotation * j.point_a);
    reach(k, b.position + b.rotation * j.point_b);
  }
  for (std::size_t k = 0; k < all.machines.size(); ++k) all.machines[k].size = norm(high[k] - low[k]);
  return all;
}

}  // namespace dem::mbd

#endif
