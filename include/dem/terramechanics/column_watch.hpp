#pragma once

#include <dem/core/stable_time_step.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/terramechanics/soil_columns.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::terramechanics {

/// Whether a part is below the ground beyond the field: below the height that the nearest column has unless pressed.
/// Its shadow (ColumnShape) is sampled in steps of a column or, where it is wider than 1000 of them, of a thousandth.
inline bool is_in_ground_beyond(const SoilColumns& soil, const ColumnPart& part) {
  const ColumnField& field = soil.field();
  const ColumnGrid& g = field.grid;
  const ShapePose pose = part.pose();
  const PlanBox box = part.shape->shadow(pose, soil.top());
  const double length_x = box.high_x - box.low_x, length_y = box.high_y - box.low_y;
  const auto count = [&](double length) { return static_cast<int>(std::clamp(length / g.spacing, 1.0, 1000.0)); };
  const int nx = count(length_x), ny = count(length_y);
  for (int iy = 0; iy < ny; ++iy) {
    for (int ix = 0; ix < nx; ++ix) {
      const double x = box.low_x + (ix + 0.5) / nx * length_x, y = box.low_y + (iy + 0.5) / ny * length_y;
      const PlanBox point = {x, x, y, y};
      if (g.holds(point)) continue;
      const ColumnRange nearest = g.around(point);
      const double ground = field.reference(g.row(nearest.to_x, nearest.to_y));
      ColumnContactPoint contact;
      if (part.shape->column_contact(pose, {x, y, g.spacing, x, y}, ground, contact)) return true;
    }
  }
  return false;
}

/// Looks at a machine on soil columns in each step that is kept, and tells what has gone wrong, each thing once: a body
/// or tread that leaves the field while it is in the ground, and a time step that is too large for the soil.
///
/// Soil of stiffness k (N/m) and damping c (N s/m) under a mass m is stable in steps h with k h^2 + 2 c h < 4 m, as
/// long as nothing else bears on the mass. A body is thrown up where that is exceeded, and where its speed changes by
/// as much as the soil's force makes of its mass alone: bodies that are held by others are let be.
class ColumnWatch {
 public:
  /// After an evaluation, dt (s) on from the last step that was kept. The parts' bodies are `body_of`.
  void look(const SoilColumns& soil, const std::vector<ColumnPart>& parts, const std::vector<BodyId>& body_of,
            const std::vector<Body>& bodies, double dt) {
    if (bearing_of_.size() != parts.size()) list(body_of);
    for (Bearing& b : bearings_) b.force = b.stiffness = b.damping = b.area = 0.0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const ColumnLoad& load = soil.loads()[k];
      Bearing& b = bearings_[bearing_of_[k]];
      b.force += load.force.z;
      b.stiffness += load.stiffness;
      b.damping += soil.spec().damping * load.area;
      b.area += load.area;
      if (!load.leaves) continue;
      bool& has_left = bearings_[bearing_of_[first_of_tread(parts, k)]].has_left;
      if (has_left || !is_in_ground_beyond(soil, parts[k])) continue;
      has_left = true;
      tell(leaving_in_words("body '" + bodies[body_of[k].index()].name + "'", parts[k], soil.field().grid));
    }
    for (Bearing& b : bearings_) follow(b, bodies[b.body.index()], dt);
  }
  /// What was found since this was last asked, in words; empty if nothing.
  std::string take() { return std::exchange(found_, {}); }
  /// Pa s/m, of the columns, that damps the bodies which press on them critically: the least of all bodies. 0: none.
  double critical_damping() const {
    double least = 0.0;
    for (const Bearing& b : bearings_) {
      if (!(b.mass > 0.0 && b.stiffness > 0.0)) continue;
      const double damping = 2.0 * std::sqrt(b.stiffness * b.mass) / b.area;
      if (least == 0.0 || damping < least) least = damping;
    }
    return least;
  }

  static constexpr std::size_t of_body = 5;  ///< numbers of collect()
  /// Appends what it remembers of so many bodies, for a saved state; restore() takes it back.
  void collect(std::size_t bodies, std::vector<double>& numbers) const {
    for (std::size_t k = 0; k < bodies; ++k) {
      const Bearing b = k < bearings_.size() ? bearings_[k] : Bearing{};  // none before the first look
      numbers.insert(numbers.end(), {b.speed, b.thrown, b.safe_step, b.is_told ? 1.0 : 0.0, b.has_left ? 1.0 : 0.0});
    }
  }
  /// `numbers` are `of_body` for each body.
  void restore(const std::vector<BodyId>& body_of, std::span<const double> numbers) {
    list(body_of);
    for (std::size_t k = 0; k < bearings_.size(); ++k) {
      const auto of = numbers.subspan(of_body * k, of_body);
      Bearing& b = bearings_[k];
      b.speed = of[0], b.thrown = of[1], b.safe_step = of[2], b.is_told = of[3] > 0.0, b.has_left = of[4] > 0.0;
    }
  }

 private:
  /// A body and the soil under all of its parts.
  struct Bearing {
    BodyId body;
    double mass = 0.0;                                   // kg; 0 while it is fixed
    double force = 0.0, stiffness = 0.0, damping = 0.0;  // N, N/m, N s/m; upwards
    double area = 0.0;                                   // m^2
    double speed = 0.0;                                  // m/s, upwards, in the step before
    double thrown = 0.0;                                 // m/s a step, where that was too large for the soil; else 0
    double safe_step = 0.0;                              // s, of the same step
    bool is_told = false;                                // that it was thrown up
    bool has_left = false;                               // the field, and it is told; of a tread: its first body
  };

  static std::size_t first_of_tread(const std::vector<ColumnPart>& parts, std::size_t k) {
    return parts[k].continues >= 0 ? static_cast<std::size_t>(parts[k].continues) : k;
  }

  void list(const std::vector<BodyId>& body_of) {
    for (std::size_t k = bearing_of_.size(); k < body_of.size(); ++k) {
      std::size_t at = 0;
      while (at < bearings_.size() && bearings_[at].body != body_of[k]) ++at;
      if (at == bearings_.size()) bearings_.push_back({.body = body_of[k]});
      bearing_of_.push_back(at);
    }
  }
  void follow(Bearing& b, const Body& body, double dt) {
    const double speed = body.motion.velocity.z, rise = speed - std::exchange(b.speed, speed);
    if (b.thrown > 0.0 && rise > 0.5 * b.thrown && !b.is_told) {
      b.is_told = true;
      tell(
          fmt::format("the soil under body '{}' asks for steps below {:g} s, but they are {:g} s: it throws the body "
                      "up; lower the time step or raise the machine's substeps",
                      body.name, rounded_down(b.safe_step), dt));
    }
    b.thrown = 0.0;
    b.mass = body.fixed ? 0.0 : body.mass;
    if (!(b.mass > 0.0 && (b.stiffness * dt + 2.0 * b.damping) * dt > 4.0 * b.mass)) return;
    b.thrown = b.force * dt / b.mass;
    b.safe_step = b.mass / (b.damping + std::sqrt(b.damping * b.damping + b.mass * b.stiffness));  // k h^2 + 2 c h = m
  }
  void tell(const std::string& what) { found_ += (found_.empty() ? "" : "; ") + what; }

  std::vector<Bearing> bearings_;
  std::vector<std::size_t> bearing_of_;  // of the parts
  std::string found_;
};

}  // namespace dem::terramechanics
