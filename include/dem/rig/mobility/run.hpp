#pragma once

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/io/drawn_surface.hpp>
#include <dem/report/replay_recorder.hpp>
#include <dem/rig/mobility/cases.hpp>
#include <dem/rig/session.hpp>
#include <dem/rig/side_by_side.hpp>
#include <dem/vehicle/drawn_hull.hpp>

#include <optional>
#include <string>
#include <thread>

namespace dem::rig::mobility {

/// A drive as a part of a run: what it has found is kept once it is done; a drive that was stopped is driven anew.
class DrivePart final : public Part {
 public:
  DrivePart(Session& session, Stages& stages, const std::string& name) : Part(session.parts(), name), stages_(stages) {
    stages_.set_part(this);
  }
  ~DrivePart() override { stages_.set_part(nullptr); }

 private:
  void collect(void*, const void*, io::StateColumns&) const override { fail("a drive has no world to be saved"); }
  void restore_state(void*, const void*, io::StateColumns&) const override {
    fail("a drive has no world to be loaded");
  }
  Stages& stages_;
};

/// Records a drive for the replay of a report: the car's wheels and hull, and the soil as tiles that sink.
class DriveReplay {
 public:
  explicit DriveReplay(report::Replay& replay) : replay_(replay) {}

  /// A car at a time (s) from the start of its drive.
  void operator()(const vehicle::ColumnCar& car, double time) {
    if (!replay_.due(time)) return replay_.pass(time);
    const auto& f = car.soil().soil().field();
    if (replay_.parts().empty()) meet(car);
    std::vector<report::ReplayGrain> tiles;
    for (std::size_t ty = 0; ty < ny_; ++ty) {
      for (std::size_t tx = 0; tx < nx_; ++tx) {
        double height = 0.0, pressure = 0.0, count = 0.0;
        for (std::size_t iy = ty * per_; iy < std::min((ty + 1) * per_, f.grid.ny); ++iy) {
          for (std::size_t ix = tx * per_; ix < std::min((tx + 1) * per_, f.grid.nx); ++ix) {
            const std::size_t row = f.grid.row(ix, iy);
            height += f.surface(row), count += 1.0;
            pressure += f.pressure[row];
          }
        }
        const double size = static_cast<double>(per_) * f.grid.spacing;
        const Vec3 at(f.grid.low_x + (static_cast<double>(tx) + 0.5) * size,
                      f.grid.low_y + (static_cast<double>(ty) + 0.5) * size, height / count - 0.5 * thick);
        tiles.push_back({.number = ty * nx_ + tx,
                         .shape = shape_,
                         .position = at,
                         .rotation = Mat3::Identity(),
                         .speed = 0.0,
                         .force = pressure / count * size * size});
      }
    }
    std::vector<report::ReplayPose> poses;
    const auto& m = car.machine;
    for (const auto& w : car.car.wheels) poses.push_back({m.body(w.body).position(), m.body(w.body).rotation(), true});
    poses.push_back({m.body(car.car.chassis).position(), m.body(car.car.chassis).rotation(), true});
    replay_.record(time, tiles, poses);
  }

 private:
  static constexpr double thick = 0.3;  ///< m, of a tile

  void meet(const vehicle::ColumnCar& car) {
    const auto& grid = car.soil().soil().field().grid;
    // At most some 6,000 tiles.
    while (grid.size() / (per_ * per_) > 6000) ++per_;
    nx_ = (grid.nx + per_ - 1) / per_;
    ny_ = (grid.ny + per_ - 1) / per_;
    const double size = static_cast<double>(per_) * grid.spacing;
    shape_ =
        replay_.add_shape({.balls = {}, .mesh = io::drawn(mesh::box(Vec3(size, size, thick))), .smooth_angle = 0.0});
    const auto& spec = car.spec().car;
    Mat3 about_y;  // a tyre's axis is z of its mesh
    about_y << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    for (const char* corner : vehicle::corner_names) {
      const IndexedMesh tyre = mesh::tyre(2.0 * spec.tyre.radius, spec.tyre.width, 600).moved(Vec3::Zero(), about_y);
      replay_.add_part(std::string(corner) + " tyre", io::drawn(tyre));
    }
    replay_.add_part("chassis", vehicle::drawn_hull(spec));
  }

  report::Replay& replay_;
  std::size_t per_ = 1, nx_ = 0, ny_ = 0, shape_ = 0;
};

/// Drives all cases of a study: passes one after the other, all others side by side, each on a thread of its own. `c`
/// is filled as the run goes.
inline void run_campaign(const Settings& s, Campaign& c, std::optional<report::Replay>& replay, Session& session) {
  c.cases = cases_of(s);
  c.results.assign(c.cases.size(), {});
  { const vehicle::ColumnCar check(car_of(s, c.cases.front())); }  // what cannot work is refused before anything goes
  session.begin_run(1);
  if (s.is_drive() && s.replay) replay.emplace(report::ReplayOptions{.frames = 120, .interval = 0.05, .grains = 7000});
  std::optional<DriveReplay> recorder;
  if (replay) recorder.emplace(*replay);
  // One drive, or passes in each other's ruts, are shown with all that they were; of the others their results are kept,
  // so that a run that was stopped goes on with those that it lacks.
  const bool is_chain = s.study == "passes", is_shown = s.is_drive() || is_chain;
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto one = [&](std::size_t k, Stages& own, double begun, double share, std::vector<double>& ruts) {
    Driven driven = drive(s, c.cases[k], ruts, own, begun, share, [&](const vehicle::ColumnCar& car, double time) {
      if (recorder) (*recorder)(car, time);
    });
    c.results[k] = driven.result;
    if (is_shown) c.shown = std::move(driven);
  };
  session.begin(s.study, is_shown ? 1.0 : static_cast<double>(c.cases.size()));
  if (is_shown) {
    std::vector<double> ruts;
    const double share = 1.0 / static_cast<double>(c.cases.size());
    for (std::size_t k = 0; k < c.cases.size(); ++k) one(k, session, share * static_cast<double>(k), share, ruts);
  } else {
    side_by_side(c.cases.size(), s.threads > 0 ? s.threads : processors, session,
                 [&](std::size_t k, SharedStages& shared) {
                   StagesOfOne own(shared, k);
                   DrivePart part(session, own, c.cases[k].name);
                   vehicle::OpenLoop inputs = s.open_loop;
                   SameSoil soil = soil_of(c.cases[k]);
                   const auto kept = own.keep("result", c.results[k]), kept_inputs = own.keep("inputs", inputs),
                              kept_soil = own.keep("soil", soil);
                   std::vector<double> ruts;
                   if (part.is_done()) own.go_on();
                   else one(k, own, 0.0, 1.0, ruts);
                   own.complete();
                   own.update(1.0);
                 });
  }
  std::size_t goes = 0;
  for (const Result& r : c.results) goes += r.goes() ? 1 : 0;
  session.finish(text("{} of {} arrived", goes, c.results.size()));
}

}  // namespace dem::rig::mobility
