#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/surface.hpp>
#include <dem/soil/kernel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace dem::soil {

/// What grains are as a continuum at a place: coarse graining after Goldhirsch (2010, doi:10.1007/s10035-010-0181-z).
/// With w(r) the kernel, m, x, v mass, place and velocity of a grain, V the average velocity, and sums over grains:
///   density           sum of m w(r - x)
///   momentum          sum of m v w(r - x) = density V
///   kinetic stress    sum of m (v - V) (v - V) w(r - x)
///   contact stress    sum over contacts of F l times the mean of w along l; l leads from the grain's centre to the
///                     contact point, F is the force that the grain exerts there. A contact of two grains has two such
///                     paths, one on a surface has one (Weinhart et al. 2012, doi:10.1007/s10035-012-0317-4).
/// So mass and momentum are balanced exactly: d(momentum)/dt = density g - div(stress + momentum V), less what surfaces
/// take at their contact points.
struct Average {
  double density = 0.0;                ///< kg/m^3, of the bulk
  double solid_fraction = 0.0;         ///< volume of grains in a volume; each grain counts where its centre is
  double grains = 0.0;                 ///< 1/m^3
  double coordination = 0.0;           ///< mean number of grains that touch a grain
  Vec3 velocity = Vec3::Zero();        ///< m/s, of the mass; 0 where there is none
  Mat3 kinetic_stress = Mat3::Zero();  ///< Pa, compression is positive
  Mat3 contact_stress = Mat3::Zero();  ///< Pa; (a, b): force along a through an area across b

  Mat3 stress() const { return kinetic_stress + contact_stress; }  ///< Pa
  double pressure() const { return stress().trace() / 3.0; }       ///< Pa
  Vec3 momentum() const { return density * velocity; }             ///< kg/(m^2 s)
  /// (m/s)^2, a third of the mean square of how velocities differ from the mean.
  double temperature() const { return density > 0.0 ? kinetic_stress.trace() / (3.0 * density) : 0.0; }
};

/// Cells of one size that fill a box.
struct AverageGrid {
  surface::Aabb box;                     ///< m, finite
  std::array<int, 3> cells = {1, 1, 1};  ///< along x, y, z

  std::size_t count() const {
    return static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(cells[2]);
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(cells[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(k));
  }
  /// m, edge of a cell.
  double edge(int axis) const { return (box.high[axis] - box.low[axis]) / cells[static_cast<std::size_t>(axis)]; }
  double volume() const { return edge(0) * edge(1) * edge(2); }  ///< m^3, of a cell
  Vec3 middle(int i, int j, int k) const {
    return box.low + Vec3((i + 0.5) * edge(0), (j + 0.5) * edge(1), (k + 0.5) * edge(2));
  }
  /// The cell, [low, high), that a place (m) is in; the box's upper faces belong to its last cells.
  std::optional<std::size_t> cell_at(const Vec3& x) const {
    std::array<int, 3> at{};
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (!(x[a] >= box.low[a] && x[a] <= box.high[a])) return {};
      at[k] = std::min(static_cast<int>((x[a] - box.low[a]) / edge(a)), cells[k] - 1);
    }
    return index(at[0], at[1], at[2]);
  }
  /// Throws Error for a box that has no volume or no end, and for less than one cell.
  void check() const {
    for (int a = 0; a < 3; ++a) {
      const double size = box.high[a] - box.low[a];
      if (!(size > 0.0) || !std::isfinite(size)) {
        fail("the box to average over has the edge {:g} m along {}, but must have a positive and finite one", size,
             "xyz"[a]);
      }
      if (cells[static_cast<std::size_t>(a)] < 1) {
        fail("the box to average over is cut into {} cells along {}, but must be into at least 1",
             cells[static_cast<std::size_t>(a)], "xyz"[a]);
      }
    }
    constexpr double most = 1e8;
    if (const double all = 1.0 * cells[0] * cells[1] * cells[2]; !(all <= most)) {
      fail("the box to average over is cut into {} x {} x {} = {:g} cells, but {:g} are allowed; make them larger",
           cells[0], cells[1], cells[2], all, most);
    }
  }
};

/// Averages at the middle of each cell of a grid.
struct Averages {
  AverageGrid grid;
  std::vector<Average> values;  ///< x runs fastest, then y

  const Average& at(int i, int j, int k) const { return values[grid.index(i, j, k)]; }
};

/// Adds up grains and paths of forces, and makes averages of them.
class AverageSums {
 public:
  AverageSums(const AverageGrid& grid, const Kernel& kernel) : grid_(grid), kernel_(kernel) {
    grid.check();
    sums_.resize(grid.count());
  }
  const AverageGrid& grid() const { return grid_; }
  const Kernel& kernel() const { return kernel_; }

  /// `touching`: how many grains touch it.
  void add_grain(double mass, double volume, const Vec3& x, const Vec3& v, double touching) {
    for_each_near(x, x, [&](Sum& sum, double weight) {
      sum.mass += weight * mass;
      sum.volume += weight * volume;
      sum.grains += weight;
      sum.touching += weight * touching;
      sum.momentum += weight * mass * v;
      sum.flow += (weight * mass) * Mat3(v * v.transpose());
    });
  }
  /// A force (N) that a grain at `from` exerts at `to`.
  void add_path(const Vec3& from, const Vec3& to, const Vec3& force) {
    const Mat3 product = force * (to - from).transpose();
    for_each_near(from, to, [&](Sum& sum, double weight) { sum.contact += weight * product; });
  }
  /// What one moment has added up to, or the mean over several: a place that has no grains for half of the moments has
  /// half the density, and its velocity is that of the mass. How velocities change from moment to moment counts in the
  /// kinetic stress. `moments` > 0 is how many were added.
  Averages averages(double moments = 1.0) const {
    require_positive(moments, "number of moments of an average", "(no unit)");
    const double share = 1.0 / moments;
    Averages result{grid_, std::vector<Average>(sums_.size())};
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const Sum& sum = sums_[k];
      Average& a = result.values[k];
      a.contact_stress = share * sum.contact;
      if (!(sum.mass > 0.0)) continue;
      a.density = share * sum.mass;
      a.solid_fraction = share * sum.volume;
      a.grains = share * sum.grains;
      a.coordination = sum.touching / sum.grains;
      a.velocity = sum.momentum / sum.mass;
      a.kinetic_stress = share * (sum.flow - Mat3(sum.momentum * a.velocity.transpose()));
    }
    return result;
  }

 private:
  struct Sum {
    double mass = 0.0, volume = 0.0, grains = 0.0, touching = 0.0;  // all by m^3
    Vec3 momentum = Vec3::Zero();
    Mat3 flow = Mat3::Zero(), contact = Mat3::Zero();
  };

  /// The part of the line from a to b that lies in a cell, [low, high); of a point, whether it does.
  static double part_within(const Vec3& a, const Vec3& b, const Vec3& low, const Vec3& high) {
    double first = 0.0, last = 1.0;
    for (int k = 0; k < 3; ++k) {
      const double d = b[k] - a[k];
      if (d == 0.0) {
        if (a[k] < low[k] || a[k] >= high[k]) return 0.0;
        continue;
      }
      const double s = (low[k] - a[k]) / d, t = (high[k] - a[k]) / d;
      first = std::max(first, std::min(s, t));
      last = std::min(last, std::max(s, t));
    }
    return std::max(0.0, last - first);
  }

  /// f(sum, weight in 1/m^3) of the cells that a line from a to b counts for.
  template <class F>
  void for_each_near(const Vec3& a, const Vec3& b, F&& f) {
    std::array<int, 3> first{}, end{};
    for (int k = 0; k < 3; ++k) {
      const auto n = static_cast<std::size_t>(k);
      const double edge = grid_.edge(k), low = grid_.box.low[k];
      const auto cell = [&](double x) {
        return static_cast<int>(std::clamp(std::floor((x - low) / edge), -1.0, grid_.cells[n] + 0.0));
      };
      first[n] = std::max(0, cell(std::min(a[k], b[k]) - kernel_.reach()));
      end[n] = std::min(grid_.cells[n], cell(std::max(a[k], b[k]) + kernel_.reach()) + 1);
    }
    for (int k = first[2]; k < end[2]; ++k) {
      for (int j = first[1]; j < end[1]; ++j) {
        for (int i = first[0]; i < end[0]; ++i) {
          double weight = 0.0;
          if (kernel_.is_cell()) {
            // Borders as products, so that neighbours have the very same one and no grain falls between them.
            const auto border = [&](int x, int y, int z) {
              return Vec3(grid_.box.low.x() + x * grid_.edge(0), grid_.box.low.y() + y * grid_.edge(1),
                          grid_.box.low.z() + z * grid_.edge(2));
            };
            weight = part_within(a, b, border(i, j, k), border(i + 1, j + 1, k + 1)) / grid_.volume();
          } else {
            weight = kernel_.along(a, b, grid_.middle(i, j, k));
          }
          if (weight > 0.0) f(sums_[grid_.index(i, j, k)], weight);
        }
      }
    }
  }

  AverageGrid grid_;
  Kernel kernel_;
  std::vector<Sum> sums_;
};

}  // namespace dem::soil
