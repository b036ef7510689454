#pragma once
// Frames for ParaView: a world now and then, as it is.

#include <dem/geometry/polyhedron/polyhedron.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/io/vtk.hpp>
#include <dem/io/vtk_grain_points.hpp>
#include <dem/io/vtk_machine.hpp>
#include <dem/rig/session.hpp>
#include <dem/soil/coordination.hpp>

#include <cmath>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace dem::rig {

/// Every grain as a point (io::write_vtk_grain_points), which also knows at how many points it touches others
/// ("contact_points") and how many touch it ("coordination").
template <class World>
void write_grain_points(const std::filesystem::path& path, const World& world, const io::VtkOptions& options) {
  const auto contacts = soil::coordination(world);
  io::write_vtk_grain_points(path, world, options,
                             {{"contact_points", 1, contacts.contacts}, {"coordination", 1, contacts.neighbours}});
}

/// Every grain as its spheres: Point Gaussian, scaled by radius_m, shows the true shape.
template <class World>
void write_grain_spheres(const std::filesystem::path& path, const World& world, const io::VtkOptions& options) {
  std::vector<Vec3> centre, velocity;
  std::vector<double> radius;
  std::vector<std::int32_t> grain;
  for (const GrainId p : world.grains()) {
    const auto& shape = world.species(world.species_of(p)).shape;
    for (int k = 0; k < shape.count(); ++k) {
      const Vec3 arm = world.rotation(p) * shape.ball(k).centre;
      centre.push_back(world.position(p) + arm);
      velocity.push_back(world.velocity(p) + world.angular_velocity(p).cross(arm));
      radius.push_back(shape.ball(k).radius);
      grain.push_back(static_cast<std::int32_t>(p.value));
    }
  }
  io::write_vtk_points(path, io::flat(centre),
                       {{"radius_m", 1, radius}, {"velocity_m_s", 3, io::flat(velocity)}, {"grain", 1, grain}},
                       options);
}

namespace detail {

using io::grain_mesh;

/// Whether a grain of this shape can be drawn as a mesh, by a function of the library or beside the shape.
template <class Shape>
concept HasMesh = requires(const Shape& shape) {
  grain_mesh(shape, 4);
};

/// Whether a shape is made of spheres that differ in place or size.
template <class Shape>
concept HasSpheres = requires(const Shape& shape) {
  shape.ball(shape.count() - 1).centre;
};

template <class World, class Write>
void add_part(io::VtkSeries& series, const World& world, const char* part, Write&& write) {
  const auto path = series.next_path(part);
  write(path, io::VtkOptions{.single_precision = true, .time_s = world.time()});
  series.add(world.time(), path, part);
}

}  // namespace detail

/// Adds the grains of a world to a series as points, "grains", with how they move and touch others.
template <class World>
void add_grains(io::VtkSeries& series, const World& world) {
  detail::add_part(series, world, "grains",
                   [&](const auto& path, const auto& options) { write_grain_points(path, world, options); });
}

/// Adds the shapes of the grains: meshes of superquadrics, polyhedra, and shapes of your own that have a
/// grain_mesh(shape, divisions) beside them; clusters as spheres if asked for. Spheres are seen by their points.
template <class World>
void add_grain_shapes(io::VtkSeries& series, const World& world, bool as_spheres = false) {
  using Shape = typename World::Shape;
  [[maybe_unused]] const auto add_meshes = [&](const char* part) {
    detail::add_part(series, world, part,
                     [&](const auto& path, const auto& options) { io::write_vtk_grains(path, world, 4, options); });
  };
  if constexpr (std::is_same_v<Shape, shape::Superquadric>) add_meshes("superquadrics");
  else if constexpr (std::is_same_v<Shape, shape::Polyhedron>) add_meshes("polyhedra");
  else if constexpr (detail::HasSpheres<Shape>) {
    if (!as_spheres) return;
    detail::add_part(series, world, "spheres",
                     [&](const auto& path, const auto& options) { write_grain_spheres(path, world, options); });
  } else if constexpr (detail::HasMesh<Shape> && !shape::BallShape<Shape>) add_meshes("meshes");
}

/// Adds the surfaces of a world to a series.
template <class World>
void add_surfaces(io::VtkSeries& series, const World& world, const char* part = "surfaces") {
  detail::add_part(series, world, part,
                   [&](const auto& path, const auto& options) { io::write_vtk_surfaces(path, world, options); });
}

/// A series of frames in the output folder, one each time that something has gone on by an interval. A series that
/// cannot be written goes no further and says why: it is not worth the run. It begins with its first frame.
class Frames {
 public:
  /// `name`.pvd; without a name nothing is written. `interval` in the unit of what goes on; `what` it shows, as in
  /// "this load". `stages` are those that the frames are of: the session, or those of one of several runs side by side.
  Frames(Session& session, Stages& stages, const std::string& name, double interval, const char* what = "this run")
      : session_(session), stages_(stages), interval_(interval), what_(what), name_(name) {}
  Frames(Session& session, const std::string& name, double interval, const char* what = "this run")
      : Frames(session, session, name, interval, what) {}

  /// Writes a frame, by write(series), if one is due where things are now.
  template <class Write>
  void show(double now, Write&& write) {
    if (now < next_) return;
    // From a multiple of the interval to the next: what a frame comes late must not add up.
    next_ = interval_ * (std::floor(now / interval_) + 1.0);
    add(now, write);
  }
  /// Writes the last frame, unless there is one of now already.
  template <class Write>
  void finish(double now, Write&& write) {
    if (now > written_) add(now, write);
  }

  /// For a run that goes on: the series goes on as well.
  template <class V>
  void fields(V& v) {
    bool is_open = series_.has_value();
    v("next", next_), v("written", written_), v("is_open", is_open);
    if (is_open && !series_) open();
    if (series_) v("series", *series_);
  }

 private:
  void open() {
    attempt([&] { series_.emplace(session_.folder() / (name_ + ".pvd")); });
  }

  template <class Write>
  void add(double now, Write&& write) {
    if (name_.empty()) return;
    if (!series_) open();
    if (!series_) return;
    written_ = now;
    attempt([&] { write(*series_); });
  }

  template <class Attempt>
  void attempt(Attempt&& attempt) {
    try {
      attempt();
    } catch (const std::exception& error) {
      series_.reset();
      name_.clear();
      stages_.alone([&] { session_.give_up_frames(error.what(), what_); });
    }
  }

  Session& session_;
  Stages& stages_;
  double interval_, next_ = 0.0, written_ = -1.0;
  const char* what_;
  std::string name_;                     // empty: nothing is written, or no more
  std::optional<io::VtkSeries> series_;  // once there is a frame
};

}  // namespace dem::rig
