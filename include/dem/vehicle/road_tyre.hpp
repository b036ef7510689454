#pragma once
// A tyre on hard ground as part of a machine.

#include <dem/mbd/load/terrain_part.hpp>
#include <dem/vehicle/tyre_watch.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dem::vehicle {

/// A tyre on a road as a terrain of a machine: its stretch is copied and saved with the machine.
class RoadTyre final : public mbd::Terrain {
 public:
  /// `axis` of the wheel is a unit vector to the left, body frame. The force goes into `load`. The name is the wheel's.
  RoadTyre(const TyreSpec& spec, const Road& road, BodyId wheel, const Vec3& axis, LoadId load, std::string name)
      : spec_(spec), road_(road), wheel_(wheel), axis_(axis), load_(load), name_(std::move(name)) {}

  /// Another tyre from now on, between two steps. The stretch of its tread goes on.
  DEM_SETUP void set_spec(const TyreSpec& spec) {
    check_tyre(spec);
    spec_ = spec;
  }

  /// In the newest evaluation of the forces.
  const TyreState& state() const { return newest_; }

  std::unique_ptr<mbd::Terrain> copy() const override { return std::make_unique<RoadTyre>(*this); }

  void evaluate(const std::vector<Body>& bodies, std::vector<mbd::Load>& loads, const mbd::TerrainStep& step) override {
    newest_ = kept_;
    const Body& wheel = bodies[wheel_.index()];
    before_.newest_share = step.newest_share;
    loads[load_.index()].wrench = tyre_wrench(spec_, road_, wheel, axis_, step.time, newest_, before_);
    before_ = {1.0, wheel.velocity(), wheel.angular_velocity()};
    if (kept_.time < 0.0) watch_.begin(spec_, wheel, newest_);
    if (step.is_kept) {
      const double dt = kept_.time >= 0.0 && step.time > kept_.time ? step.time - kept_.time : 0.0;
      watch_.look(spec_, road_, wheel, axis_, newest_, dt);
    }
    if (step.is_kept || kept_.time < 0.0) kept_ = newest_;  // the first evaluation starts the clock
  }

  std::string set_up() const override {
    const TyreSpec& t = spec_;
    const Vec3 &p = road_.point, &n = road_.normal;
    const std::string ground = road_.heights ? road_.heights->in_words()
                                             : text("a plane through ({}, {}, {}) m across ({}, {}, {})", p.x(), p.y(),
                                                    p.z(), n.x(), n.y(), n.z());
    return text(
        "tyre of {} m x {} m, stiffness {}, damping {}, friction {}, tread stiffness {} and {}, tread damping {}, "
        "relaxation length {}, axis ({}, {}, {}), of body {} on {}, friction {}, print {} m",
        t.radius, t.width, t.stiffness, t.damping, t.friction, t.tread_stiffness, t.lateral_stiffness, t.tread_damping,
        t.relaxation_length, axis_.x(), axis_.y(), axis_.z(), wheel_.value, ground, road_.friction, road_.print);
  }
  std::vector<double> memory() const override {
    std::vector<double> numbers;
    for (const TyreState* s : {&kept_, &newest_}) {
      TyreState copy = *s;
      copy.each([&](double x) { numbers.push_back(x); });
    }
    TyreWatch copy = watch_;
    copy.each([&](double x) { numbers.push_back(x); });
    return numbers;
  }
  void set_memory(const std::vector<double>& numbers) override {
    const std::size_t count = memory().size();
    if (numbers.size() != count) fail("the saved memory of a tyre has {} numbers, but needs {}", numbers.size(), count);
    auto next = numbers.begin();
    for (TyreState* s : {&kept_, &newest_}) {
      s->each([&](double& x) { x = *next++; });
    }
    watch_.each([&](double& x) { x = *next++; });
  }
  std::string take_problem() override { return watch_.take(); }
  std::string note() const override { return watch_.note(name_, spec_.radius); }

 private:
  TyreSpec spec_;
  Road road_;
  BodyId wheel_;
  Vec3 axis_;
  LoadId load_;
  std::string name_;  ///< of the wheel
  TyreWatch watch_;
  TyreState kept_, newest_;  ///< of the newest step, of the newest evaluation
  TreadSpeeds before_;       ///< in the evaluation before; of the same step, where they count
};

}  // namespace dem::vehicle
