#pragma once

// Repeatable random numbers, poses and shapes for tests that try many of them; the same with every standard library but
// for direction().

#include <dem/math/vector.hpp>

#include <random>

class Random {
 public:
  explicit Random(unsigned seed = 1) : engine_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  double unit() { return between(-1.0, 1.0); }
  std::size_t below(std::size_t count) { return engine_() % count; }

  /// Inside of a box about the origin.
  dem::Vec3 in(const dem::Vec3& half) {
    const double x = between(-half.x(), half.x()), y = between(-half.y(), half.y());
    return {x, y, between(-half.z(), half.z())};
  }
  dem::Vec3 vector(double size = 1.0) { return in(dem::Vec3::Constant(size)); }
  dem::Vec3 direction() {
    std::normal_distribution<double> normal;
    const double x = normal(engine_), y = normal(engine_);
    return dem::Vec3(x, y, normal(engine_)).normalized();
  }
  dem::Mat3 rotation() {
    const double angle = between(0.0, 3.0);
    return Eigen::AngleAxisd(angle, vector().normalized()).toRotationMatrix();
  }
  dem::Vec3 radii() { return dem::Vec3::Ones() + vector(0.4); }

 private:
  std::mt19937 engine_;
};
