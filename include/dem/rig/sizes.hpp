#pragma once

#include <dem/core/error.hpp>

#include <string_view>

namespace dem::rig {

/// How much work a run is: `smoke` takes seconds and shows that all works, `quick` takes minutes, `full` is the
/// experiment.
enum class Size { smoke, quick, full };

/// The size of that name. Throws Error for any other.
inline Size size_named(std::string_view name) {
  if (name == "smoke") return Size::smoke;
  if (name == "quick") return Size::quick;
  if (name == "full") return Size::full;
  fail("--size is '{}', but must be smoke, quick or full", name);
}

/// What differs between the sizes.
template <class T>
struct BySize {
  T smoke, quick, full;
  const T& operator[](Size size) const { return size == Size::smoke ? smoke : size == Size::quick ? quick : full; }
};

/// Gives a number that was left open, 0, its value by size.
inline void fill(double& value, double by_size) {
  if (value == 0.0) value = by_size;
}

}  // namespace dem::rig
