#pragma once

#include <dem/soil/average.hpp>
#include <dem/world/contacts.hpp>

namespace dem::soil {

/// Density, velocity, stress, ... of a world's grains as it stands, at the middle of each cell of a grid; see Average.
/// The world is not changed. Throws Error for a grid that is none, and as contacts_of does.
///
///     const auto field = soil::averages(world, {{low, high}, {20, 20, 10}}, soil::Kernel::lucy(4 * radius));
template <class Model>
Averages averages(const World<Model>& world, const AverageGrid& grid, const Kernel& kernel = Kernel::cell()) {
  AverageSums sums(grid, kernel);
  std::vector<int> touching(world.state().particles.row_of.size(), 0);
  const ContactForce* before = nullptr;
  const auto contacts = contacts_of(world);
  for (const auto& c : contacts) {
    if (c.kind == ContactKind::bodies) continue;
    sums.add_path(c.centre(), c.point, -c.force);
    if (c.kind != ContactKind::grains) continue;
    sums.add_path(c.point, c.other_centre(), -c.force);
    const bool same_pair =
        before != nullptr && before->grain == c.grain && before->other_grain == c.other_grain;  // they come together
    if (!same_pair && c.overlap >= 0.0) {
      ++touching[c.grain.index()];
      ++touching[c.other_grain.index()];
      before = &c;
    }
  }
  for (const ParticleId p : world.particles()) {
    const auto& kind = world.species(world.species_of(p));
    sums.add_grain(kind.mass, kind.shape.volume(), world.position(p), world.velocity(p), touching[p.index()]);
  }
  return sums.averages();
}

/// The average over a box.
template <class Model>
Average average_in(const World<Model>& world, const surface::Bounds& box) {
  return averages(world, {box, {1, 1, 1}}).values[0];
}
/// The averages over n slices of a box, across an axis (0: x, 1: y, 2: z). Throws Error for another axis.
template <class Model>
std::vector<Average> average_slices(const World<Model>& world, const surface::Bounds& box, int axis, int n) {
  if (axis < 0 || axis > 2) fail("slices are asked for across axis {}, but it must be 0 (x), 1 (y) or 2 (z)", axis);
  AverageGrid grid{box, {1, 1, 1}};
  grid.cells[static_cast<std::size_t>(axis)] = n;
  return averages(world, grid).values;
}

}  // namespace dem::soil
