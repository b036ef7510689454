#pragma once

#include <dem/soil/average.hpp>
#include <dem/world/contacts.hpp>

namespace dem::soil {

namespace detail {

/// From a grain to all of its images in and around a periodic cell; 0 of open space.
template <class Domain>
std::vector<Vec3> shifts_of(const Domain& domain) {
  std::vector<Vec3> shifts = {Vec3(0, 0, 0)};
  if constexpr (domain::IsSheared<Domain>) {
    // Cells above and below stand anywhere along x: two on either side reach as far as one does here.
    const auto& period = domain.period();
    const double offset = std::remainder(domain.offset(), period[0]);
    shifts.clear();
    for (int k = -1; k <= 1; ++k) {
      for (int j = period[1] > 0.0 ? -1 : 0; j <= (period[1] > 0.0 ? 1 : 0); ++j) {
        const int most = k == 0 ? 1 : 2;
        for (int i = -most; i <= most; ++i)
          shifts.push_back(Vec3(i * period[0] + k * offset, j * period[1], k * period[2]));
      }
    }
  } else if constexpr (Domain::has_images) {
    for (int axis = 0; axis < 3; ++axis) {
      const double period = domain.period()[static_cast<std::size_t>(axis)];
      if (period == 0.0) continue;
      const std::size_t known = shifts.size();
      for (std::size_t k = 0; k < known; ++k) {
        for (const double side : {-period, period}) shifts.push_back(shifts[k] + side * Vec3(Vec3::Unit(axis)));
      }
    }
  }
  return shifts;
}

/// Throws Error where averages are asked for beyond the images next to a periodic cell.
template <class Domain>
void check_box_in_images(const AverageSums& sums, const Domain& domain) {
  if constexpr (Domain::has_images) {
    const surface::Aabb& box = sums.grid().box;
    const double reach = sums.kernel().reach();
    for (std::size_t k = 0; k < 3; ++k) {
      const double period = domain.period()[k], low = domain.low(k);
      const int axis = static_cast<int>(k);
      if (period == 0.0) continue;
      const double from = low - period + reach, to = low + 2.0 * period - reach;
      if (box.low[axis] >= from - 1e-9 * period && box.high[axis] <= to + 1e-9 * period) continue;
      fail(
          "the box to average over reaches from {:g} to {:g} m along {}, where the domain repeats itself every {:g} m; "
          "of its images those next to the cell are counted, so take a box between {:g} and {:g} m",
          box.low[axis], box.high[axis], "xyz"[k], period, from, to);
    }
  }
}

/// Adds the grains and contacts of a world as it stands.
template <class Model>
void add_world(AverageSums& sums, const World<Model>& world) {
  check_box_in_images(sums, world.state().domain);
  std::vector<int> touching(world.state().grains.given, 0);
  const ContactForce* before = nullptr;
  const auto contacts = contacts_of(world);
  const auto shifts = shifts_of(world.state().domain);
  for (const auto& c : contacts) {
    if (c.kind == ContactKind::bodies) continue;
    for (const Vec3& shift : shifts) {
      sums.add_path(c.centre() + shift, c.point + shift, -c.force);
      if (c.kind == ContactKind::grains) sums.add_path(c.point + shift, c.other_centre() + shift, -c.force);
    }
    if (c.kind != ContactKind::grains) continue;
    const bool same_pair =
        before != nullptr && before->grain == c.grain && before->other_grain == c.other_grain;  // they come together
    if (!same_pair && c.overlap >= 0.0) {
      ++touching[c.grain.index()];
      ++touching[c.other_grain.index()];
      before = &c;
    }
  }
  for (const GrainId p : world.grains()) {
    const auto& kind = world.species(world.species_of(p));
    for (const Vec3& shift : shifts) {
      Vec3 velocity = world.velocity(p);
      if constexpr (domain::IsSheared<typename Model::Domain>) {
        velocity.x() += world.state().domain.shear_rate() * shift.z();
      }
      sums.add_grain(kind.mass, kind.shape.volume(), world.position(p) + shift, velocity, touching[p.index()]);
    }
  }
}

}  // namespace detail

/// Density, velocity, stress, ... of a world's grains as it stands, at the middle of each cell of a grid; see Average.
/// Images of a periodic cell count too, one cell on. The world is not changed. Throws Error for a grid that is none or
/// reaches beyond these images, and as contacts_of does. The velocity of a cell of the grid is one mean: how it changes
/// within the cell counts as kinetic stress, density (rate L)^2/12 of a shear rate over a height L. Thin cells have
/// little of it. Where ranks share the grains, all ranks call it at once.
///
///     const auto field = soil::averages(world, {{low, high}, {20, 20, 10}}, soil::Kernel::lucy(4 * radius));
template <class Model>
Averages averages(const World<Model>& world, const AverageGrid& grid, const Kernel& kernel = Kernel::cell()) {
  AverageSums sums(grid, kernel);
  detail::add_world(sums, world);
  return sums.averages();
}

/// The same over time: means over the moments at which a world was added.
///
///     soil::TimeAverages mean({{low, high}, {1, 1, 20}});
///     for (int k = 0; k < 1000; ++k) {
///       if (const auto report = world.run_for(1e-3); !report) return fmt::print("{}\n", report.text), 1;
///       mean.add(world);
///     }
///     for (const soil::Average& slice : mean.averages().values) fmt::print("{} m/s\n", slice.velocity.x());
class TimeAverages {
 public:
  /// Throws Error for a grid that is none.
  explicit TimeAverages(const AverageGrid& grid, const Kernel& kernel = Kernel::cell()) : sums_(grid, kernel) {}

  /// Adds a world as it stands. Throws as contacts_of does. Where ranks share the grains, all ranks call it at once.
  template <class Model>
  void add(const World<Model>& world) {
    detail::add_world(sums_, world);
    moments_ += 1.0;
  }

  [[nodiscard]] double moments() const { return moments_; }  ///< that were added
  /// Throws Error if no world was added.
  [[nodiscard]] Averages averages() const {
    if (moments_ == 0.0) fail("averages over time have no moments; add(world) while the world runs");
    return sums_.averages(moments_);
  }

 private:
  AverageSums sums_;
  double moments_ = 0.0;
};

/// The average over a box.
template <class Model>
Average average_in(const World<Model>& world, const surface::Aabb& box) {
  return averages(world, {box, {1, 1, 1}}).values[0];
}
/// The averages over n slices of a box, across an axis (0: x, 1: y, 2: z). Throws Error for another axis.
template <class Model>
std::vector<Average> average_slices(const World<Model>& world, const surface::Aabb& box, int axis, int n) {
  if (axis < 0 || axis > 2) fail("slices are asked for across axis {}, but it must be 0 (x), 1 (y) or 2 (z)", axis);
  AverageGrid grid{box, {1, 1, 1}};
  grid.cells[static_cast<std::size_t>(axis)] = n;
  return averages(world, grid).values;
}

}  // namespace dem::soil
