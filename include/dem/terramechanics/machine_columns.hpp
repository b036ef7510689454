#pragma once

#include <dem/terramechanics/column_terrain.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace dem::terramechanics {

/// Soil columns under a machine: its own, or that of a world, which step with it, are copied with it, and are part of
/// its saved state (dem::save, dem::load).
///
///     MachineColumns soil(machine, {.length_x = 5, .length_y = 1, .soil = melanz_sand});
///     soil.add(wheel, std::make_shared<ColumnCylinder>(0.13, 0.16), machine.body(wheel).position());
///
///     auto soil = world.add_soil_columns(ColumnsSpec{.length_x = 5, .length_y = 1, .soil = melanz_sand});
///
/// This is a handle: the machine has the columns. of() makes one for a copy of the machine. Grains do not feel the
/// columns, only machine parts do. The force on each body is a load, "soil under <body>", which can be switched off and
/// is counted as work like any other. terramechanics/rut_vtk.hpp writes ruts for ParaView: add_vtk_frame(series, time,
/// soil.soil().field()).
///
/// The stable time step does not know the soil: a step below sqrt(m/k) with k = loads()[part].stiffness is safe. A step
/// at which the soil throws a body up ends the run once, with a problem that names the body; so does a part that leaves
/// the field.
class MachineColumns {
 public:
  /// Throws Error for a field that cannot be (check_columns), or a name that another terrain of the machine has.
  MachineColumns(mbd::Mechanism& machine, const ColumnsSpec& spec, std::string name = {}) : machine_(&machine) {
    auto terrain = std::make_unique<ColumnTerrain>(spec);
    id_ = mbd::add_terrain(machine, std::move(name), std::move(terrain));
  }
  /// The same columns in a machine that was copied from this one. Throws Error if it has none.
  [[nodiscard]] MachineColumns of(mbd::Mechanism& machine) const {
    MachineColumns other = *this;
    other.machine_ = &machine;
    if (dynamic_cast<ColumnTerrain*>(&mbd::terrain_of(machine, id_)) == nullptr)
      fail("terrain {} of the machine is no field of soil columns; give a copy of the machine that has them",
           id_.value);
    return other;
  }

  /// A shape fixed to a body: where its frame is now (m, global) and how it is turned. `width` (m) is b of the pressure
  /// law; 0: the shape's. `friction` is mu of the part on the soil. Returns the part's number in loads(). Throws Error
  /// for a body that is not there, no shape, no width, or a negative friction.
  std::size_t add(BodyId body, std::shared_ptr<const ColumnShape> shape, const Vec3& at,
                  const Mat3& rotation = Mat3::Identity(), double width = 0.0, double friction = ColumnPart::rough) {
    const Body& b = machine_->body(body);
    if (!shape)
      fail("body '{}' was given no shape for the soil columns; give it one, such as a ColumnCylinder", b.name);
    if (!((width > 0.0 ? width : shape->width()) > 0.0)) {
      fail("the shape of body '{}' for the soil columns tells no width, which the pressure law asks for; give one",
           b.name);
    }
    require_non_negative(friction, "friction of a part on soil columns", "(no unit)");
    const Matrix3<double>& r = b.motion.rotation;
    const ColumnPart part = {.shape = std::move(shape),
                             .body = b.motion,
                             .position = transpose_times(r, from_eigen(at) - b.motion.position),
                             .rotation = transposed(r) * from_eigen(rotation),
                             .width = width,
                             .friction = friction};
    LoadId load;
    for (std::size_t k = 0; k < terrain().parts.size(); ++k) {
      if (terrain().body_of[k] == body) load = terrain().load_of[k];
    }
    if (!load.valid()) {
      const std::string on = machine_->parts().terrains.size() > 1 ? terrain_name() : "soil";
      load = machine_->add_load(mbd::terrain_load(on + " under " + b.name, body));
      terrain().own_loads.push_back(load);
    }
    ColumnTerrain& t = terrain();
    t.parts.push_back(part);
    t.body_of.push_back(body);
    t.name_of.push_back(machine_->body(body).name);
    t.load_of.push_back(load);
    return t.parts.size() - 1;
  }

  /// A part goes on with an earlier one: soil below both stays in contact when it passes from one to the other, as
  /// below the pieces of one tread. `first` is the tread's first part; the others follow it one after the other. Throws
  /// Error otherwise.
  void continue_part(std::size_t part, std::size_t first) {
    std::vector<ColumnPart>& parts = terrain().parts;
    const bool follows = part > first && part < parts.size() &&
                         (part == first + 1 || parts[part - 1].continues == static_cast<std::int32_t>(first));
    if (!follows || parts[first].continues >= 0) {
      fail(
          "part {} on soil columns is to go on with part {} of {}; name the tread's first part, and its other parts "
          "one "
          "after the other",
          part, first, parts.size());
    }
    parts[part].continues = static_cast<std::int32_t>(first);
  }

  SoilColumns& soil() { return terrain().soil; }
  const SoilColumns& soil() const { return terrain().soil; }
  /// What each part feels, in the newest evaluation of the forces.
  const std::vector<ColumnLoad>& loads() const { return soil().loads(); }
  /// What became of the newest evaluation: a part that leaves the soil is told here, and in the notes of the reports of
  /// machine and world. The first time it ends their run as a problem.
  const ColumnsReport& report() const { return terrain().report; }
  TerrainId id() const { return id_; }

 private:
  ColumnTerrain& terrain() const { return static_cast<ColumnTerrain&>(mbd::terrain_of(*machine_, id_)); }
  const std::string& terrain_name() const { return machine_->parts().terrains[id_.index()].name; }

  mbd::Mechanism* machine_;
  TerrainId id_;
};

/// Adds soil columns to a machine: what World::add_soil_columns calls.
inline MachineColumns make_soil_columns(mbd::Mechanism& machine, const ColumnsSpec& spec) { return {machine, spec}; }

}  // namespace dem::terramechanics
