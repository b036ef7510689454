#pragma once
// What the VTK writers take: named arrays, and how to store them.

#include <dem/core/error.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace dem::io {

/// What digits of numbers are kept that are stored as 32-bit floats: rounded numbers take less room in a compressed
/// file.
struct Rounding {
  int bits = 23;      ///< of the mantissa, 1 to 23: 10 keep three digits
  double step = 0.0;  ///< numbers become multiples of it; a power of two; 0: they do not
};

/// A named array with one tuple of `components` values a point (or a body); it looks at memory of the caller's, which
/// must outlive the writing. Vectors of numbers convert:
///
///     PointData{"radius_m", 1, radii}, PointData{"velocity_m_s", 3, flat(velocities)}, PointData{"species", 1, ids}
struct DataArray {
  using Values = std::variant<std::span<const double>, std::span<const float>, std::span<const std::int32_t>,
                              std::span<const std::int64_t>, std::span<const std::uint8_t>,
                              std::span<const std::uint32_t>, std::span<const std::uint64_t>>;

  std::string name;        ///< shown by ParaView; not empty, and not twice in a file
  int components = 1;      ///< 1 scalar, 3 vector, 9 tensor by rows, ...
  Values values = {};      ///< x0 y0 z0 x1 y1 z1 ...
  Rounding rounding = {};  ///< of doubles that are stored in single precision

  [[nodiscard]] std::size_t size() const {
    return std::visit([](const auto& span) { return span.size(); }, values);
  }
};
using PointData = DataArray;  ///< one tuple a point
using BodyData = DataArray;   ///< one tuple a body

struct VtkOptions {
  /// Stores double arrays as 32-bit floats: half the size, 7 digits. Enough to look at; not to compute from.
  bool single_precision = false;
  /// Time [s] that ParaView shows for the file itself; NaN: none.
  double time_s = std::numeric_limits<double>::quiet_NaN();
  /// Of positions that are stored in single precision.
  Rounding position_rounding = {};
};

/// The numbers of a contiguous range of vectors, in order: {{1,2,3},{4,5,6}} -> 1 2 3 4 5 6. The vectors may be Eigen's
/// of fixed size (Vec3) or structs of x, y and z (Vector3<double>).
template <std::ranges::contiguous_range Vectors>
[[nodiscard]] auto flat(const Vectors& vectors) {
  using Vector = std::ranges::range_value_t<Vectors>;
  const auto first_number = [](const Vector& v) {
    if constexpr (requires { v.data(); }) return v.data();
    else return &v.x;
  };
  using Scalar = std::remove_cvref_t<decltype(*first_number(std::declval<const Vector&>()))>;
  static_assert(std::is_arithmetic_v<Scalar> && std::is_trivially_destructible_v<Vector> &&
                    sizeof(Vector) % sizeof(Scalar) == 0 && sizeof(Vector) <= 16 * sizeof(Scalar),
                "flat() needs vectors of fixed size that hold nothing but their numbers");
  const std::size_t n = std::ranges::size(vectors);
  return std::span<const Scalar>(n == 0 ? nullptr : first_number(*std::ranges::data(vectors)),
                                 n * (sizeof(Vector) / sizeof(Scalar)));
}

/// Three columns as one array x0 y0 z0 x1 y1 z1 ... Throws dem::Error when they differ in length.
[[nodiscard]] inline std::vector<double> interleave(std::span<const double> x, std::span<const double> y,
                                                    std::span<const double> z) {
  if (x.size() != y.size() || x.size() != z.size()) {
    fail("interleave: {} x, {} y and {} z values; give as many of each", x.size(), y.size(), z.size());
  }
  std::vector<double> vectors;
  vectors.reserve(3 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) vectors.insert(vectors.end(), {x[i], y[i], z[i]});
  return vectors;
}

}  // namespace dem::io
