#pragma once
// Records what moves, for the replay of a report.

#include <dem/core/error.hpp>
#include <dem/report/quantise.hpp>
#include <dem/report/replay_data.hpp>
#include <dem/report/replay_mesh.hpp>
#include <dem/report/replay_thinning.hpp>
#include <dem/report/three_js.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::report {

/// Keeps frames of grains and machine parts, to be turned and watched in a report:
///
///     Replay replay({.frames = 100});
///     while (...) {
///       world.run_for(0.01);
///       replay.record(world);              // with <dem/report/replay_world.hpp>
///     }
///     html_report.replay(replay, "The bed while it is sheared.");
///
/// It needs 28 bytes a grain and frame, and 36 a force and frame. Without a world: add_shape, add_part, and the other
/// record().
class Replay {
 public:
  /// Throws dem::Error for options outside of their ranges, and when a file of three.js is named that is not there.
  explicit Replay(ReplayOptions options = {})
      : options_(std::move(options)), ticks_(options_.interval), sample_(options_.grains) {
    if (options_.frames < 2 || options_.frames > 10'000) {
      fail("a replay was given {} frames, but takes 2 to 10000; some 100 make a page of a few megabytes",
           options_.frames);
    }
    require_non_negative(options_.interval, "time between frames of a replay", "s");
    require_positive(options_.plane_size, "edge of a plane in a replay", "m");
    if (options_.grains < 1) fail("a replay was told to draw 0 grains; let ReplayOptions::grains be at least 1");
    check_three_js(options_.three_js);
  }

  /// Adds a look of grains and returns its number; that of an earlier one which is the same. Throws dem::Error for a
  /// radius that is not positive, and a mesh that has no faces or names a vertex that it has not.
  std::size_t add_shape(ReplayShape shape) {
    for (const ReplayBall& ball : shape.balls) require_positive(ball.radius, "radius of a ball in a replay", "m");
    if (shape.balls.empty()) detail::check_replay_mesh(shape.mesh, fmt::format("shape {}", shapes_.size()));
    if (const auto same = std::find(shapes_.begin(), shapes_.end(), shape); same != shapes_.end()) {
      return static_cast<std::size_t>(same - shapes_.begin());
    }
    shapes_.push_back(std::move(shape));
    return shapes_.size() - 1;
  }

  /// Adds a part of a machine and returns its number. Throws dem::Error for a mesh as above.
  std::size_t add_part(std::string name, io::SurfaceMesh mesh) {
    if (name.empty()) name = fmt::format("part {}", parts_.size() + 1);
    detail::check_replay_mesh(mesh, "part '" + name + "'");
    parts_.push_back({std::move(name), std::move(mesh)});
    return parts_.size() - 1;
  }

  /// Whether record() at this time (s) would make a frame.
  [[nodiscard]] bool due(double time) const { return frames_.empty() || (time > last_time_ && ticks_.due(time)); }

  /// Makes a frame, if one is due, of all grains that are there, of all parts, a pose each, and of the forces at
  /// contacts, one for each pair that touches; of these the largest are kept. What has a number that is not finite in
  /// single precision is not drawn. Returns whether a frame was made; a time that was recorded before is passed over.
  /// Throws dem::Error for a time that is not finite or goes back, a shape that was never added or is not that of
  /// earlier frames, and another number of poses than parts.
  bool record(double time, std::span<const ReplayGrain> grains, std::span<const ReplayPose> poses = {},
              std::span<const ReplayForce> forces = {}) {
    check_frame(time, grains, poses);
    for (const ReplayForce& f : forces) check_number(f.grain), check_number(f.partner);
    if (!frames_.empty() && time == last_time_) return false;
    if (due(time) && frames_.size() == static_cast<std::size_t>(options_.frames)) drop_every_second();
    const bool is_due = due(time);
    if (is_due) keep(time, grains, poses, forces);
    ticks_.count(time);
    last_time_ = time;
    return is_due;
  }

  /// Counts a call of record() at a time (s) at which none is due, without looking at anything.
  void pass(double time) {
    if (frames_.empty() || !(time > last_time_)) return;
    ticks_.count(time);
    last_time_ = time;
  }

  /// Makes a frame of a world as it is now, if one is due: its grains, its active surfaces, and bodies as meshes.
  /// Include <dem/report/replay_world.hpp>, which says more.
  template <class World, class... Bodies>
  requires std::is_class_v<World>
  bool record(const World& world, const Bodies&... bodies) { return record_world(*this, world, bodies...); }

  [[nodiscard]] const ReplayOptions& options() const { return options_; }
  [[nodiscard]] const std::vector<KeptFrame>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<ReplayShape>& shapes() const { return shapes_; }
  [[nodiscard]] const std::vector<ReplayPart>& parts() const { return parts_; }
  /// Which grains there were, and which of them are drawn. Frames may still hold some that no longer are.
  [[nodiscard]] const GrainSample& sample() const { return sample_; }
  /// What positions are kept relative to (m): the middle of the first frame.
  [[nodiscard]] const Vec3& origin() const { return origin_; }

  /// Which shapes and parts a world's species, surfaces and bodies are, by their indices; for record(world).
  struct OfWorld {
    std::vector<std::size_t> species, surfaces, bodies;
    template <class V>
    void fields(V& v) {
      v("species", species), v("surfaces", surfaces), v("bodies", bodies);
    }
  };
  [[nodiscard]] OfWorld& of_world() { return of_world_; }

  /// What was recorded so far (see io::Fields), for a run that goes on after it was stopped.
  template <class V>
  void fields(V& v) {
    v("ticks", ticks_), v("sample", sample_), v("shapes", shapes_), v("parts", parts_), v("frames", frames_);
    v("origin", origin_, "m"), v("last_time", last_time_, "s"), v("of_world", of_world_);
  }

 private:
  static void check_number(std::size_t number) {
    if (number >= std::size_t{1} << 31)
      fail("replay: a grain has the number {}; number grains and surfaces from 0 on", number);
  }
  void check_frame(double time, std::span<const ReplayGrain> grains, std::span<const ReplayPose> poses) const {
    if (!std::isfinite(time)) fail("replay: the time of a frame is {}; give a finite time in seconds", time);
    if (!frames_.empty() && time < last_time_) {
      fail("replay: a frame at {:g} s after one at {:g} s; record in the order of time", time, last_time_);
    }
    if (poses.size() != parts_.size()) {
      fail("replay: a frame has {} poses, but there are {} parts; give one for each, in the order of add_part",
           poses.size(), parts_.size());
    }
    for (const ReplayGrain& g : grains) {
      if (g.shape >= shapes_.size()) {
        fail("replay: grain {} has shape {}, but {} were added (from 0 on); use what add_shape returned", g.number,
             g.shape, shapes_.size());
      }
      check_number(g.number);
      const std::uint32_t before = sample_.shape_of(g.number);
      if (before != GrainSample::kUnmet && before != g.shape) {
        fail("replay: grain {} has shape {}, but had {} before; give a grain of another shape another number", g.number,
             g.shape, before);
      }
    }
  }

  /// Those that stay are as far apart as all later ones will be.
  void drop_every_second() {
    for (std::size_t k = 1; 2 * k < frames_.size(); ++k) frames_[k] = std::move(frames_[2 * k]);
    frames_.resize((frames_.size() + 1) / 2);
    ticks_.halve();
  }

  void find_origin(std::span<const ReplayGrain> grains, std::span<const ReplayPose> poses) {
    Vec3 sum = Vec3::Zero();
    double count = 0.0;
    const auto add = [&](const auto& items) {
      for (const auto& item : items) {
        if (!fits_single(item.position)) continue;
        sum += item.position;
        count += 1.0;
      }
    };
    add(grains);
    if (count == 0.0) add(poses);
    if (count > 0.0) origin_ = sum / count;
  }

  /// The largest forces, by their pairs. Of several of one pair, as two grains have in a narrow periodic cell, the
  /// largest one.
  [[nodiscard]] std::vector<ReplayForce> strongest(std::span<const ReplayForce> forces) const {
    const auto is_known = [this](const ReplayForce& f) {
      return fits_single(f.from - origin_) && fits_single(f.to - origin_) && fits_single(f.force) && f.force > 0.0;
    };
    const auto same_pair = [](const ReplayForce& a, const ReplayForce& b) {
      return a.grain == b.grain && a.on_surface == b.on_surface && a.partner == b.partner;
    };
    const auto by_pair = [](const ReplayForce& a, const ReplayForce& b) {
      if (a.grain != b.grain) return a.grain < b.grain;
      if (a.on_surface != b.on_surface) return b.on_surface;
      return a.partner != b.partner ? a.partner < b.partner : a.force > b.force;
    };
    std::vector<ReplayForce> kept;
    if (options_.force_lines > 0) std::copy_if(forces.begin(), forces.end(), std::back_inserter(kept), is_known);
    std::sort(kept.begin(), kept.end(), by_pair);
    kept.erase(std::unique(kept.begin(), kept.end(), same_pair), kept.end());
    if (kept.size() <= options_.force_lines) return kept;
    // Equal forces by their pairs, so that the order in which they are given does not count.
    const auto end = kept.begin() + static_cast<std::ptrdiff_t>(options_.force_lines);
    std::nth_element(kept.begin(), end, kept.end(), [&](const ReplayForce& a, const ReplayForce& b) {
      return a.force != b.force ? a.force > b.force : by_pair(a, b);
    });
    kept.erase(end, kept.end());
    std::sort(kept.begin(), kept.end(), by_pair);
    return kept;
  }

  void keep(double time, std::span<const ReplayGrain> grains, std::span<const ReplayPose> poses,
            std::span<const ReplayForce> forces) {
    if (frames_.empty()) find_origin(grains, poses);
    KeptFrame frame{.time = time, .grains = {}, .poses = {}, .forces = {}};
    for (const ReplayForce& f : strongest(forces)) {
      frame.forces.push_back({static_cast<std::uint32_t>(f.grain), static_cast<std::uint32_t>(f.partner) & 0x7fffffffU,
                              f.on_surface ? 1U : 0U, single(f.from - origin_), single(f.to - origin_),
                              static_cast<float>(f.force)});
    }
    for (const ReplayGrain& g : grains) sample_.meet(g.number, g.shape);
    for (const ReplayGrain& g : grains) {
      if (!sample_.draws(g.number)) continue;
      const Vec3 x = g.position - origin_;
      if (!fits_single(x) || !g.rotation.allFinite() || !fits_single(g.speed) || !fits_single(g.force)) continue;
      KeptGrain& kept = frame.grains.emplace_back();
      kept.number = static_cast<std::uint32_t>(g.number) & 0x7fffffffU;
      kept.is_asleep = g.is_asleep ? 1 : 0;
      kept.position = single(x);
      kept.rotation = pack_rotation(quaternion_of(g.rotation));
      kept.speed = static_cast<float>(g.speed);
      kept.force = static_cast<float>(g.force);
    }
    for (const ReplayPose& p : poses) {
      const Vec3 x = p.position - origin_;
      KeptPose& kept = frame.poses.emplace_back();
      if (!p.shown || !fits_single(x) || !p.rotation.allFinite()) continue;
      const auto [a, b, c] = single(x);
      const auto q = quaternion_of(p.rotation);
      kept = {a,
              b,
              c,
              static_cast<float>(q[0]),
              static_cast<float>(q[1]),
              static_cast<float>(q[2]),
              static_cast<float>(q[3])};
    }
    frames_.push_back(std::move(frame));
  }
  /// Whether a number is finite in single precision, in which frames are kept.
  static bool fits_single(double x) { return std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()); }
  static bool fits_single(const Vec3& x) { return fits_single(x.x()) && fits_single(x.y()) && fits_single(x.z()); }
  static std::array<float, 3> single(const Vec3& x) {
    return {static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())};
  }

  ReplayOptions options_;
  FrameTicks ticks_;
  GrainSample sample_;
  std::vector<ReplayShape> shapes_;
  std::vector<ReplayPart> parts_;
  std::vector<KeptFrame> frames_;
  Vec3 origin_ = Vec3::Zero();
  double last_time_ = 0.0;
  OfWorld of_world_;
};

}  // namespace dem::report
