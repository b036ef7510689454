#pragma once
// Grains at rest in their container, kept as a file, so that several piles start from one fill.

#include <dem/core/output.hpp>
#include <dem/rig/sand_pile/settings.hpp>
#include <dem/soil/packing_file.hpp>

#include <string>
#include <utility>
#include <vector>

namespace dem::rig::sand_pile {

/// m, length and width of the container's floor, and where its middle is along x.
struct ContainerFloor {
  double length, width, middle;
};
inline ContainerFloor container_floor_of(const Settings& s) {
  if (s.method != "drain") return {2.0 * s.cylinder_radius, 2.0 * s.cylinder_radius, 0.0};
  return {s.box_length + s.slot_width, s.box_width, 0.5 * (s.slot_width - s.box_length)};
}

/// The container in the words of the options: a fill of one stands in no other.
inline std::string container_words(const Settings& s) {
  const std::string plate = "--method " + s.method + " --plate " + s.plate;
  if (s.method == "drain") {
    return text("{} --box-length {} --box-width {} --slot-width {}", plate, s.box_length, s.box_width, s.slot_width);
  }
  const std::string cylinder = text("{} --cylinder-radius {}", plate, s.cylinder_radius);
  if (s.method == "lift") return cylinder;
  return text("{} --orifice-radius {} --orifice-height {} --funnel-angle {}", cylinder, s.orifice_radius,
              s.orifice_height, s.funnel_angle_deg);
}

/// Writes grains of that shape, at rest in their container. Throws Error if that does not work.
inline void save_fill(const Settings& s, const std::string& shape, std::vector<soil::Placement> grains,
                      const std::filesystem::path& path) {
  const ContainerFloor floor = container_floor_of(s);
  for (auto& grain : grains) grain.position.x() -= floor.middle;
  soil::save_packing({s.half_edge, floor.length, floor.width, container_words(s), std::move(grains), shape}, path);
}

/// Reads the fill of --fill-file. `shape`: that it must have; empty: any. Throws Error if it is no fill, or not one of
/// these grains in this container.
inline std::vector<soil::Placement> read_fill(const Settings& s, const std::string& shape) {
  soil::Packing p = soil::load_packing(s.fill_file);
  if (!p.note.starts_with("--method ")) {
    fail("'{}' is no fill of a container; give the file KIND_SEED_filled.txt of an earlier run as --fill-file",
         s.fill_file);
  }
  if (!shape.empty() && p.shape != shape) {
    fail("the fill '{}' has grains of shape {}, but the pile is one of {}; give --kinds {}, or another --fill-file",
         s.fill_file, p.shape, shape, p.shape);
  }
  if (p.grains.size() != s.grains || p.half_edge != s.half_edge) {
    fail(
        "the fill '{}' has {} grains of half-edge {} m, but the settings say {} of {} m; give --grains {} "
        "--half-edge {}",
        s.fill_file, p.grains.size(), p.half_edge, s.grains, s.half_edge, p.grains.size(), p.half_edge);
  }
  if (p.note != container_words(s)) {
    fail("the fill '{}' lies in another container than that of the settings, {}; give {}", s.fill_file,
         container_words(s), p.note);
  }
  const double middle = container_floor_of(s).middle;
  for (auto& grain : p.grains) grain.position.x() += middle;
  return std::move(p.grains);
}

}  // namespace dem::rig::sand_pile
