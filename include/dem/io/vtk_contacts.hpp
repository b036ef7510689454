#pragma once
// Force chains for ParaView (.vtp).

#include <dem/io/vtk_lines.hpp>
#include <dem/io/vtk_series.hpp>
#include <dem/world/contacts.hpp>
#include <dem/world/force_lines.hpp>

namespace dem::io {

/// Writes force chains as lines from grain to grain and from grain to surface, with the arrays "force" and
/// "normal_force" and "friction" [N], "overlap" [m], "points" (at which the two touch), "on_surface" (1 or 0), "grain"
/// (the number of the grain at the line's first end), "other_grain" (that at its second end, -1: it is a surface),
/// "surface" (the number of the surface there, -1: it is a grain) and "force_on_grain_N" (vector, on the first). Its
/// opposite is on the other. ParaView's filter Tube draws them as thick as "force". Throws dem::Error as
/// write_vtk_lines does.
inline void write_vtk_force_lines(const std::filesystem::path& path, const std::vector<ForceLine>& lines,
                                  const VtkOptions& options = {}) {
  std::vector<double> ends, force, normal, friction, overlap;
  std::vector<Vec3> on_grain;
  std::vector<std::int32_t> points, on_surface, surface;
  std::vector<std::uint32_t> grain;
  std::vector<std::int64_t> other_grain;
  for (const ForceLine& line : lines) {
    for (const Vec3& end : {line.from, line.to}) ends.insert(ends.end(), end.data(), end.data() + 3);
    force.push_back(line.force.norm());
    normal.push_back(line.normal_force);
    friction.push_back(line.friction.norm());
    overlap.push_back(line.overlap);
    points.push_back(line.points);
    on_surface.push_back(line.surface.valid() ? 1 : 0);
    grain.push_back(line.grain.value);
    other_grain.push_back(line.other_grain.valid() ? std::int64_t{line.other_grain.value} : -1);
    surface.push_back(line.surface.valid() ? static_cast<std::int32_t>(line.surface.value) : -1);
    on_grain.push_back(line.force);
  }
  write_vtk_lines(path, ends,
                  {{"force", 1, std::span<const double>(force)},
                   {"normal_force", 1, std::span<const double>(normal)},
                   {"friction", 1, std::span<const double>(friction)},
                   {"overlap", 1, std::span<const double>(overlap)},
                   {"points", 1, std::span<const std::int32_t>(points)},
                   {"on_surface", 1, std::span<const std::int32_t>(on_surface)},
                   {"grain", 1, std::span<const std::uint32_t>(grain)},
                   {"other_grain", 1, std::span<const std::int64_t>(other_grain)},
                   {"surface", 1, std::span<const std::int32_t>(surface)},
                   {"force_on_grain_N", 3, flat(on_grain)}},
                  options);
}

/// The same of all contacts of a world as it stands. Where ranks share the grains, all ranks call it at once, and rank
/// 0 writes.
template <class Model>
void write_vtk_contacts(const std::filesystem::path& path, const World<Model>& world, const VtkOptions& options = {}) {
  write_vtk_force_lines(path, force_lines(contacts_of(world)), options);
}

/// Adds them to a time series as "contacts".
///
///     VtkSeries series("out/bed.pvd");
///     add_vtk_frame(series, world);     // vtk_machine.hpp
///     add_vtk_contacts(series, world);
template <class Model>
void add_vtk_contacts(VtkSeries& series, const World<Model>& world) {
  const auto path = series.next_path("contacts");
  write_vtk_contacts(path, world, {.single_precision = true, .time_s = world.time()});
  series.add(world.time(), path, "contacts");
}

}  // namespace dem::io
