#pragma once

// The wrapper of include/dem/README.md.

#include <memory>
#include <string>

class Soil {
 public:
  explicit Soil(double friction);
  ~Soil();
  void add_grain(double x, double y, double z);  // m
  std::string run_for(double seconds);           // what went wrong; empty if nothing
  double weight_on_floor() const;                // N

 private:
  struct Hidden;
  std::unique_ptr<Hidden> hidden_;
};
