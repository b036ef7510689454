#pragma once

#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace dem::rig::rigid_wheel {

/// Stresses of the grains on a wheel's rim: means over the moments that were looked at, in cells of 5 degrees along
/// the rim and of some grain's edge across it. The angle is 0 at the lowest point of the rim and grows forward.
struct ContactPrint {
  static constexpr std::size_t along = 30;  ///< cells, of 5 deg each from -60 to 90 deg
  static constexpr double low = -std::numbers::pi / 3.0, step = std::numbers::pi / 36.0;  ///< rad

  double radius = 0.0, width = 0.0;  ///< m
  std::size_t across = 0;            ///< cells
  double moments = 0.0;
  std::vector<double> radial = {};      ///< N, towards the axle, summed over the moments; cell (a, w) at w * along + a
  std::vector<double> tangential = {};  ///< N, likewise: forward at the lowest point, so that it brakes a driven wheel

  /// Cells about as wide as a grain's edge (m), 4 to 20 of them.
  void set_up(double wheel_radius, double wheel_width, double edge) {
    radius = wheel_radius, width = wheel_width, moments = 0.0;
    across = static_cast<std::size_t>(std::clamp(std::round(width / edge), 4.0, 20.0));
    radial.assign(along * across, 0.0);
    tangential.assign(along * across, 0.0);
  }
  /// A force (N) on the wheel at a place (m) from its middle: x forward, y along the axle, z up. What lies outside of
  /// the angles counts with the first or last cell.
  void add(const Vec3& place, const Vec3& force) {
    const double angle = std::atan2(place.x(), -place.z()), c = std::cos(angle), s = std::sin(angle);
    const double a = std::floor((angle - low) / step);
    const double w = std::floor((place.y() / width + 0.5) * static_cast<double>(across));
    const std::size_t cell = static_cast<std::size_t>(std::clamp(w, 0.0, static_cast<double>(across - 1))) * along +
                             static_cast<std::size_t>(std::clamp(a, 0.0, static_cast<double>(along - 1)));
    radial[cell] += c * force.z() - s * force.x();
    tangential[cell] += c * force.x() + s * force.z();
  }

  [[nodiscard]] bool empty() const { return moments == 0.0; }
  [[nodiscard]] double angle(std::size_t a) const { return low + (static_cast<double>(a) + 0.5) * step; }  ///< rad
  /// m, of the middle of a cell across.
  [[nodiscard]] double place(std::size_t w) const {
    return width * ((static_cast<double>(w) + 0.5) / static_cast<double>(across) - 0.5);
  }
  [[nodiscard]] double cell_area() const { return radius * step * width / static_cast<double>(across); }  ///< m^2
  /// Pa, of a cell.
  [[nodiscard]] double pressure(std::size_t a, std::size_t w) const {
    return radial[w * along + a] / (moments * cell_area());
  }
  [[nodiscard]] double shear(std::size_t a, std::size_t w) const {
    return tangential[w * along + a] / (moments * cell_area());
  }
  /// Pa, across the whole width.
  [[nodiscard]] double pressure(std::size_t a) const { return mean(radial, a); }
  [[nodiscard]] double shear(std::size_t a) const { return mean(tangential, a); }

  /// m^2, of the cells of most pressure that together carry 95 % of the radial force.
  [[nodiscard]] double area() const {
    std::vector<double> cells = radial;
    std::sort(cells.begin(), cells.end(), [](double a, double b) { return a > b; });
    double all = 0.0, sum = 0.0;
    for (const double f : cells) all += f;
    std::size_t n = 0;
    while (n < cells.size() && cells[n] > 0.0 && sum < 0.95 * all) sum += cells[n++];
    return static_cast<double>(n) * cell_area();
  }
  /// Pa, of 95 % of the radial force on that area.
  [[nodiscard]] double mean_pressure() const {
    double all = 0.0;
    for (const double f : radial) all += f;
    return 0.95 * all / (moments * area());
  }
  /// The cell along the rim that is pressed most.
  [[nodiscard]] std::size_t peak() const {
    std::size_t best = 0;
    for (std::size_t a = 1; a < along; ++a) best = pressure(a) > pressure(best) ? a : best;
    return best;
  }

  template <class V>
  void fields(V& v) {
    v("radius", radius), v("width", width), v("across", across), v("moments", moments);
    v.numbers("radial", radial), v.numbers("tangential", tangential);
  }

 private:
  [[nodiscard]] double mean(const std::vector<double>& sums, std::size_t a) const {
    double sum = 0.0;
    for (std::size_t w = 0; w < across; ++w) sum += sums[w * along + a];
    return sum / (moments * cell_area() * static_cast<double>(across));
  }
};

}  // namespace dem::rig::rigid_wheel
