#pragma once

#include <dem/math/vector.hpp>

#include <cstdint>

namespace dem {

/// A callback for the checks of concepts; a real one evaluates the contact.
struct AnyCallback {
  template <class ContactPoint>
  void operator()(std::uint32_t, const ContactPoint&) const {}             ///< as shapes call it
  void operator()(std::uint32_t, const Vector3<double>&, double) const {}  ///< as surfaces call it
};

}  // namespace dem
