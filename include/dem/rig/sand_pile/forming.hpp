#pragma once

#include <dem/rig/sand_pile/apparatus.hpp>
#include <dem/rig/sand_pile/results.hpp>
#include <dem/rig/stages.hpp>
#include <dem/soil/rest.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

// The stages of a pile: grains are filled in, let go, come to rest, and are watched for creep.

namespace dem::rig::sand_pile {

/// The flank of these grains, as the method has it. It has no angle where it does not fall, or where the heap is lower
/// than least_height(): a step of one grain is then most of what the lines go through.
inline soil::Flank flank_of(std::span<const soil::Placement> grains, const Settings& s, double radius) {
  soil::FlankOptions o{.low = s.flank_low, .high = s.flank_high, .directions = s.directions};
  soil::Flank flank;
  if (s.method == "drain") {
    o.directions = std::max<std::size_t>(1, s.directions / 3);
    flank = soil::flank_of_slope(grains, radius, -s.box_length, 0.0, 0.5 * s.box_width, o);
  } else {
    flank = soil::flank_of_heap(grains, radius, s.plate_radius, o);
  }
  if (!(flank.angle > 0.0) || flank.height < least_height(s)) flank.angle = flank.scatter = not_known;
  return flank;
}

/// What a stage of a pile has come to.
struct StageOfPile {
  double start = 0.0;  ///< s
  soil::StaysBelow slow = {0.0, 0.0};
  std::size_t flowing = 0;
  bool done = false;
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("slow", slow), v("flowing", flowing), v("done", done);
  }
};

/// One pile while it is made: its apparatus, and what is kept of it.
template <class Model, class Look>
class Forming {
 public:
  /// `look(world)` is called every sampling interval.
  Forming(const Settings& s, Apparatus<Model>& rig, double radius, PileResult& result, Stages& stages, Look& look)
      : s_(s),
        rig_(rig),
        radius_(radius),
        size_(std::cbrt(4.0 / 3.0 * std::numbers::pi) * radius),
        result_(result),
        stages_(stages),
        look_(look) {}

  /// What stages leave to later ones, for a run that goes on after it was stopped.
  template <class V>
  void fields(V& v) {
    v("lift_start", lift_start_, "s"), v("lift_way", lift_way_, "m"), v("grains_of_pile", ids_);
  }

  /// Lets the grains come to rest in their container.
  void fill() {
    stages_.begin(result_.kind.name + ": fill", s_.settle_limit);
    StageOfPile n{.start = rig_.world.time(), .slow = {soil::rest_speed(size_), 0.05}};
    const auto stage = stages_.enter(rig_.world, n);
    if (stage && !rest(n, s_.settle_limit)) {
      throw Stopped(
          text("the grains are not at rest in their container after {:g} s; raise --settle-limit or --damping",
               s_.settle_limit));
    }
    if (stage) result_.fill = soil::placements(rig_.world);
  }

  /// Lifts the cylinder over the grains, or opens the funnel or the slot until nothing flows out of it any more.
  void let_go() {
    is_let_go_ = true;
    if (s_.method == "lift") return lift();
    stages_.begin(result_.kind.name + ": flow");
    // As long as it takes a grain to fall from the orifice, or out of sight, and a little more.
    StageOfPile n{.start = rig_.world.time(), .slow = {0.5, 0.3}, .flowing = flowing() + 1};
    const auto stage = stages_.enter(rig_.world, n, [&] { rig_.open(); });
    if (!stage) return;
    while (!n.done && !n.slow(rig_.world.time(), n.flowing == flowing() ? 0.0 : 1.0)) {
      n.flowing = flowing();
      go_on();
      const double time = rig_.world.time() - n.start;
      n.done = s_.method == "drain" && time >= s_.flow_limit;  // what creeps never ends: it is measured as it is
      stages_.update(time, status());
      if (!n.done && time >= s_.flow_limit) {
        throw Stopped(text("grains still flow after {:g} s; raise --flow-limit", s_.flow_limit));
      }
    }
    if (s_.method == "funnel" && flowing() > 0) {
      throw Stopped(text("{} grains stay in the funnel, which is blocked; widen --orifice-radius (now {:g} m)",
                         flowing(), s_.orifice_radius));
    }
  }

  /// Waits until the pile stands, measures it, and watches it.
  void measure() {
    stages_.begin(result_.kind.name + ": rest", s_.rest_limit);
    StageOfPile n{.start = rig_.world.time(), .slow = {0.1 * soil::rest_speed(size_), 0.05}};
    const auto wake = [this] { rig_.world.set_sleep(std::nullopt); };  // grains that sleep would not creep
    if (const auto stage = stages_.enter(rig_.world, n, wake)) {
      result_.at_rest = rest(n, s_.rest_limit);
      ids_ = rig_.world.grains();
      result_.pile = soil::placements(rig_.world);
      result_.flank = flank_of(result_.pile, s_, radius_);
    }
    stages_.begin(result_.kind.name + ": creep", s_.creep_time);
    n = {.start = rig_.world.time()};
    const auto stage = stages_.enter(rig_.world, n, wake);
    if (!stage) return;
    while (rig_.world.time() < n.start + s_.creep_time) go_on(), stages_.update(rig_.world.time() - n.start, status());
    result_.creep_time = rig_.world.time() - n.start;
    find_creep();
  }

 private:
  void lift() {
    NoNumbers none;
    const auto stage = stages_.enter(rig_.world, none, [&] {
      if (lift_way_ == 0.0) {
        lift_way_ = soil::height_percentile(soil::placements(rig_.world), 1.0) + 4.0 * s_.half_edge;
        lift_start_ = rig_.world.time();
      }
      rig_.lift(lift_way_, lift_start_);
    });
    const double time = rig_.lift_time(lift_way_);
    stages_.begin(result_.kind.name + ": lift", time);
    if (stage && !stage.begins()) stages_.go_on();
    while (stage && rig_.world.time() < lift_start_ + time) {
      go_on();
      stages_.update(rig_.world.time() - lift_start_, status());
    }
  }

  void find_creep() {
    result_.angle_after = flank_of(soil::placements(rig_.world), s_, radius_).angle;
    std::vector<double> ways;
    double square = 0.0;
    const std::vector<GrainId> left = rig_.world.grains();
    for (std::size_t k = 0, next = 0; k < ids_.size(); ++k) {
      while (next < left.size() && left[next].index() < ids_[k].index()) ++next;
      if (next == left.size() || left[next] != ids_[k]) continue;  // it fell off
      ways.push_back((rig_.world.position(ids_[k]) - result_.pile[k].position).norm() / size_);
      square += ways.back() * ways.back();
    }
    if (ways.empty()) return;
    result_.creep = std::sqrt(square / static_cast<double>(ways.size()));
    std::nth_element(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2), ways.end());
    result_.creep_median = ways[ways.size() / 2];
  }

  /// Goes on for a sampling interval.
  void go_on() {
    use_free_threads(rig_.world, stages_);
    run(rig_.world, s_.sample_time);
    result_.lost += rig_.remove_fallen();
    if (rig_.world.grain_count() == 0) throw Stopped("no grain is left");
    const auto grains = soil::placements(rig_.world);
    const soil::Flank flank = flank_of(grains, s_, radius_);
    const bool is_free = is_let_go_ && !(s_.method == "lift" && rig_.cylinder_holds_grains());
    result_.samples.push_back({rig_.world.time(), is_free ? flank.angle * 180.0 / std::numbers::pi : not_known,
                               flank.height, soil::rms_speed(rig_.world), static_cast<double>(grains.size())});
    look_(rig_.world);
  }
  /// Goes on until the grains are slow for 50 ms; whether they are, by the time `longest` (s).
  bool rest(StageOfPile& n, double longest) {
    while (!n.done && rig_.world.time() - n.start < longest) {
      go_on();
      n.done = n.slow(rig_.world.time(), result_.samples.back().speed);
      stages_.update(rig_.world.time() - n.start, status());
    }
    return n.done;
  }
  std::string status() const {
    const Sample& sample = result_.samples.back();
    const std::string speed = text("grains at {:.2g} mm/s", 1e3 * sample.speed);
    return std::isfinite(sample.angle) ? text("{:.1f} deg, {}", sample.angle, speed) : speed;
  }
  /// Grains that are in the funnel, or that are in the box at all.
  std::size_t flowing() const {
    if (s_.method == "drain") return rig_.world.grain_count();
    std::size_t count = 0;
    for (const GrainId p : rig_.world.grains()) {
      count += rig_.world.position(p).z() > s_.orifice_height - s_.half_edge;
    }
    return count;
  }

  const Settings& s_;
  Apparatus<Model>& rig_;
  double radius_, size_;  // m, of the sphere and of the cube with a grain's volume
  PileResult& result_;
  Stages& stages_;
  Look& look_;
  bool is_let_go_ = false;
  double lift_start_ = 0.0, lift_way_ = 0.0;  // s, m
  std::vector<GrainId> ids_;                  // of the pile as it was measured
};

}  // namespace dem::rig::sand_pile
