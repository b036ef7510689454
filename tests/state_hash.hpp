#pragma once

// A number that stands for the bits of a world: two worlds that differ in one bit have different ones.

#include <dem/math/vector.hpp>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>

class Hash {
 public:
  template <class Numbers>
  void add(const Numbers& numbers) {
    for (Eigen::Index k = 0; k < numbers.size(); ++k) {
      value_ ^= std::bit_cast<std::uint64_t>(numbers.data()[k]);
      value_ *= 0x100000001b3ULL;
      value_ ^= value_ >> 29;
    }
  }
  std::string text() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value_));
    return text;
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Places, velocities and rotations of all grains and bodies; places of grains are seen from `origin`.
template <class World>
std::string hash_of(const World& w, const dem::Vec3& origin = dem::Vec3::Zero()) {
  Hash hash;
  for (const auto p : w.grains()) {
    hash.add(dem::Vec3(w.position(p) - origin));
    hash.add(w.velocity(p));
    hash.add(w.angular_velocity(p));
    hash.add(w.rotation(p));
  }
  for (const auto& b : w.machine().bodies()) {
    hash.add(b.position());
    hash.add(b.velocity());
    hash.add(b.angular_velocity());
    hash.add(b.rotation());
  }
  return hash.text();
}
