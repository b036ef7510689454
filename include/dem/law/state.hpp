#pragma once

#include <dem/math/vector.hpp>

#include <cstddef>
#include <type_traits>

namespace dem::contact {

/// What a normal law may read about one contact (T = double) or a pack of contacts (T = Pack).
///
/// Laws describe whole contacts. A contact may be a patch of points, each with a weight: a share or an area
/// (Geometry::weight). The laws are then evaluated at each point as if it were the whole contact, and the result is
/// multiplied by it: A of eq. 25.
///
/// Points whose shares add up to S < 1 are together a spring S K. A law that makes its damper c(m) from a damping ratio
/// and the effective mass m is then handed m/S. The mass m/S swings on K as m does on S K. So the damper S c(m/S) is
/// the asked share of the critical damping of S K and m, and the restitution is the one that was asked for.
template <class T>
struct NormalState {
  T overlap;                 ///< m, d of eq. 25; not negative where the bodies touch
  T approach_speed;          ///< m/s, d' of eq. 26; positive while the bodies move together
  T effective_radius;        ///< m, 1/(1/Ri + 1/Rj)
  T effective_mass;          ///< kg, 1/(1/mi + 1/mj); over S for points whose shares add up to S < 1
  T time_step;               ///< s, by which the history moves on: a step over the integrator's stages
  T whole_step = time_step;  ///< s, that the force acts for
};

/// What a friction law may read.
template <class T>
struct TangentialState {
  Vector3<T> velocity;       ///< m/s, of i relative to j at the contact point, in the tangent plane (eq. 28)
  T normal_force;            ///< N, not negative; of a whole contact, as in NormalState
  T overlap;                 ///< m
  T effective_radius;        ///< m
  T effective_mass;          ///< kg
  T time_step;               ///< s, as of NormalState
  T whole_step = time_step;  ///< s, that the force acts for
};

/// Number of doubles in a law's Parameters or History struct, which holds nothing but Ts; an empty struct has none.
template <class Struct>
inline constexpr int field_count = std::is_empty_v<Struct> ? 0 : static_cast<int>(sizeof(Struct) / sizeof(double));

/// Stands for a T where sizes are counted.
template <std::size_t Bytes>
struct SizedNumber {
  unsigned char bytes[Bytes];
};
/// Whether a law's Parameters or History grow with the size of a T as if they held nothing but Ts: contacts are read
/// and written number by number. Another member fits one odd size at most.
template <template <class> class Struct>
inline constexpr bool holds_numbers_alone = std::is_empty_v<Struct<double>> ||
                                            (sizeof(Struct<SizedNumber<3>>) == 3 * field_count<Struct<double>> &&
                                             sizeof(Struct<SizedNumber<5>>) == 5 * field_count<Struct<double>>);

}  // namespace dem::contact
