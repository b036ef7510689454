#pragma once

#include <dem/mbd/load/terrain_part.hpp>
#include <dem/terramechanics/soil_columns.hpp>
#include <dem/terramechanics/soil_text.hpp>

#include <memory>
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
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k].body = bodies[body_of[k].index()].motion;
    if (step.time < kept_) kept_ = step.time;  // the machine's clock was set back
    report = soil.evaluate(parts, kept_ >= 0.0 && step.time > kept_ ? step.time - kept_ : 0.0);
    for (const LoadId l : own_loads) loads[l.index()].wrench = {};
    for (std::size_t k = 0; k < soil.loads().size(); ++k) {
      mbd::Load& load = loads[load_of[k].index()];
      load.wrench = load.wrench + Wrench{soil.loads()[k].force, soil.loads()[k].torque};
    }
    if (!step.is_kept) return;
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
    for (std::size_t k = 0; k < parts.size(); ++k) {
      words += fmt::format("; body {} with width {}, friction {}", body_of[k].value, parts[k].width, parts[k].friction);
      if (parts[k].continues >= 0) words += fmt::format(", goes on with part {}", parts[k].continues);
    }
    return words;
  }
  std::vector<double> memory() const override {
    std::vector<double> numbers = {kept_};
    soil.collect(numbers);
    return numbers;
  }
  void set_memory(const std::vector<double>& numbers) override {
    if (numbers.empty()) fail("the saved memory of soil columns is empty");
    kept_ = numbers[0];
    soil.restore(std::span(numbers).subspan(1));
  }
  std::string problem() const override { return report.text; }

  SoilColumns soil;
  std::vector<ColumnPart> parts;
  std::vector<BodyId> body_of;    ///< of the parts
  std::vector<LoadId> load_of;    ///< of the parts: parts of one body share one
  std::vector<LoadId> own_loads;  ///< of the bodies
  ColumnsReport report;

 private:
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

  double kept_ = -1.0;  ///< s, of the state that is kept; below 0: none is yet
};

}  // namespace dem::terramechanics
