#pragma once

#include <dem/math/fingerprint.hpp>
#include <dem/mbd/load/terrain_part.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/column_watch.hpp>
#include <dem/terramechanics/soil_columns.hpp>
#include <dem/terramechanics/soil_text.hpp>

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::terramechanics {

/// Soil columns as the terrain of a machine: what MachineColumns adds. What columns remember is kept once a step of the
/// machine, in its last stage; integrators may look at a step more than once.
class ColumnTerrain final : public mbd::Terrain {
 public:
  explicit ColumnTerrain(const ColumnsSpec& spec) : soil(spec) {}

  std::unique_ptr<mbd::Terrain> copy() const override { return std::make_unique<ColumnTerrain>(*this); }

  void evaluate(const std::vector<Body>& bodies, std::vector<mbd::Load>& loads, const mbd::TerrainStep& step) override {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      parts[k].before = parts[k].body;
      parts[k].body = bodies[body_of[k].index()].motion;
      parts[k].newest_share = step.newest_share;
    }
    if (step.time < kept_) kept_ = step.time;  // the machine's clock was set back
    const double dt = kept_ >= 0.0 && step.time > kept_ ? step.time - kept_ : 0.0;
    report = soil.evaluate(parts, dt);
    if (report.part >= 0) report.text = body_in_words(static_cast<std::size_t>(report.part)) + ": " + report.text;
    for (const LoadId l : own_loads) loads[l.index()].wrench = {};
    for (std::size_t k = 0; k < soil.loads().size(); ++k) {
      mbd::Load& load = loads[load_of[k].index()];
      load.wrench = load.wrench + Wrench{soil.loads()[k].force, soil.loads()[k].torque};
    }
    if (!step.is_kept) return;
    watch_.look(soil, parts, body_of, bodies, dt);
    soil.commit();
    kept_ = step.time;
  }

  std::string set_up() const override {
    const ColumnsSpec& s = soil.spec();
    std::string words =
        fmt::format("{} x {} columns of {} m from ({}, {}) m, at {} m, {} m thick, damping {}, bulldozing {} at {} rad",
                    soil.field().grid.nx, soil.field().grid.ny, s.spacing, s.low_x, s.low_y, s.height, s.thickness,
                    s.damping, s.bulldozing, s.angle_of_repose);
    for (const Soil& of : soil.soils()) words += "; " + in_words(of);
    if (!soil.field().soil.empty()) words += fmt::format("; laid out as {:016x}", fingerprint_of(soil.field().soil));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      words += fmt::format("; body {} with a {}{}, width {}, friction {}", body_of[k].value, parts[k].shape->set_up(),
                           place_in_words(parts[k]), parts[k].width, parts[k].friction);
      if (parts[k].continues >= 0) words += fmt::format(", goes on with part {}", parts[k].continues);
    }
    return words;
  }
  std::vector<double> memory() const override {
    std::vector<double> numbers = {kept_};
    watch_.collect(own_loads.size(), numbers);
    soil.collect(numbers);
    return numbers;
  }
  void set_memory(const std::vector<double>& numbers) override {
    const std::size_t watched = ColumnWatch::of_body * own_loads.size();
    if (numbers.size() < 1 + watched) {
      fail("the saved memory of soil columns has {} numbers, but the {} bodies on them alone have {}", numbers.size(),
           own_loads.size(), 1 + watched);
    }
    const std::span<const double> all(numbers);
    soil.restore(all.subspan(1 + watched));
    watch_.restore(body_of, all.subspan(1, watched));
    kept_ = numbers[0];
  }
  std::string take_problem() override { return watch_.take(); }
  std::string note() const override {
    std::string words = report.text.empty() ? "" : report.text + ".";
    const auto add = [&](const std::string& note) { words += (words.empty() ? "" : " ") + note; };
    std::size_t lowest = 0;
    double depth = 0.0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (const double here = depth_of_axle(k); here > depth) lowest = k, depth = here;
    }
    if (depth > 0.0) {
      add(fmt::format(
          "{} has its axle {:.3g} m below the ground, where columns do not tell a wheel's forces; check the "
          "soil's constants, which are in Pa and m, and the load.",
          body_in_words(lowest), depth));
    }
    if (const double critical = soil.spec().damping > 0.0 ? 0.0 : watch_.critical_damping(); critical > 0.0) {
      add(
          fmt::format("Soil columns without damping let what stands on them bounce, and creep down slopes; set damping "
                      "of ColumnsSpec, as to {:.1g} Pa s/m.",
                      0.1 * critical));
    }
    return words;
  }

  SoilColumns soil;
  std::vector<ColumnPart> parts;
  std::vector<BodyId> body_of;       ///< of the parts
  std::vector<std::string> name_of;  ///< of the parts' bodies
  std::vector<LoadId> load_of;       ///< of the parts: parts of one body share one
  std::vector<LoadId> own_loads;     ///< of the bodies
  ColumnsReport report;

 private:
  std::string body_in_words(std::size_t part) const { return "body '" + name_of[part] + "'"; }
  /// m, of a wheel's axle below the ground that the wheel has not pressed; 0 or less for parts that do not press, and
  /// for discs that lie flat.
  double depth_of_axle(std::size_t part) const {
    if (soil.loads().size() <= part || soil.loads()[part].columns == 0) return 0.0;
    if (dynamic_cast<const ColumnCylinder*>(parts[part].shape.get()) == nullptr) return 0.0;
    const ShapePose pose = parts[part].pose();
    if (std::abs(pose.rotation.row2.y) >= 0.7) return 0.0;  // as in ColumnCylinder::shadow
    const Vector3<double>& at = pose.position;
    const PlanBox middle = {at.x, at.x, at.y, at.y};
    if (!soil.field().grid.holds(middle)) return 0.0;
    const ColumnRange there = soil.field().grid.around(middle);
    return soil.field().reference(soil.field().grid.row(there.to_x, there.to_y)) - at.z;
  }

  /// Every number of a soil.
  static std::string in_words(const Soil& of) {
    Soil soil = of;
    double angles[2] = {soil.shear.friction_angle, soil.exit_angle};
    std::string words = "soil with";
    const detail::SoilNumbers numbers(soil, angles);
    for (std::size_t k = 0; k < numbers.count; ++k) {
      words += fmt::format(" {} {}", numbers.rows[k].name, *numbers.rows[k].value);
    }
    return words;
  }

  /// Where a shape is on its body. To 1e-9: what it follows from, the body's pose, is only known to its rounding.
  static std::string place_in_words(const ColumnPart& part) {
    const auto rounded = [](const Vector3<double>& v) {
      const auto digits = [](double x) { return std::round(1e9 * x) / 1e9 + 0.0; };  // -0 is 0
      return Vector3<double>{digits(v.x), digits(v.y), digits(v.z)};
    };
    const Vector3<double> at = rounded(part.position);
    const Matrix3<double>& r = part.rotation;
    return fmt::format(" at ({}, {}, {}) m, turned {:016x}", at.x, at.y, at.z,
                       fingerprint_of(rounded(r.row0), rounded(r.row1), rounded(r.row2)));
  }

  ColumnWatch watch_;
  double kept_ = -1.0;  ///< s, of the state that is kept; below 0: none is yet
};

}  // namespace dem::terramechanics
