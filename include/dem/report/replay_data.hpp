#pragma once
// What a replay is made of: plain data, without a world.

#include <dem/io/surface_mesh.hpp>
#include <dem/math/vector.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dem::report {

/// How a replay is recorded.
struct ReplayOptions {
  /// At most so many frames (2 to 10,000) are kept. When there would be more, every second one goes and the time
  /// between frames doubles: however long a run gets, its frames are spread evenly over it.
  int frames = 100;
  /// Time between frames (s) as long as there are few enough; 0: each call of record() is a frame.
  double interval = 0.0;
  /// At most so many grains are drawn, spread evenly over their numbers; the page says how many there were.
  std::size_t grains = 50'000;
  /// So many of the contacts of a frame are drawn as force chains, those with the largest forces; 0: none.
  std::size_t force_lines = 2'000;
  /// Edge of the square (m) that shows a plane of a world, which has no end.
  double plane_size = 1.0;
  /// File of three.js (its build as one script); empty: found by find_three_js.
  std::string three_js = {};
};

/// A ball of a grain.
struct ReplayBall {
  Vec3 centre = Vec3::Zero();  ///< m, in the grain's frame
  double radius = 0.0;         ///< m, > 0
  bool operator==(const ReplayBall&) const = default;
  template <class V>
  void fields(V& v) {
    v("centre", centre, "m"), v("radius", radius, "m");
  }
};

/// What grains of a species look like, in the grain's frame: balls, or else a mesh.
struct ReplayShape {
  std::vector<ReplayBall> balls = {};  ///< drawn with more or fewer triangles as there are fewer or more of them
  io::SurfaceMesh mesh = {};           ///< where there are no balls
  double smooth_angle = 0.0;           ///< rad; edges of the mesh that bend less are shaded round
  bool operator==(const ReplayShape&) const = default;
  template <class V>
  void fields(V& v) {
    v("balls", balls), v("mesh", mesh), v("smooth_angle", smooth_angle, "rad");
  }
};

/// A grain in a frame.
struct ReplayGrain {
  std::size_t number = 0;            ///< which grain it is, the same in all frames
  std::size_t shape = 0;             ///< what add_shape returned, the same in all frames
  Vec3 position = Vec3::Zero();      ///< m
  Mat3 rotation = Mat3::Identity();  ///< from the grain's frame to the world
  double speed = 0.0;                ///< m/s
  double force = 0.0;                ///< N, the size of the net contact force
  bool is_asleep = false;            ///< it is not worked on, as it rests
};

/// Where a part of a machine is in a frame.
struct ReplayPose {
  Vec3 position = Vec3::Zero();      ///< m, of the mesh's origin
  Mat3 rotation = Mat3::Identity();  ///< from the mesh's frame to the world
  bool shown = true;
};

/// What passes between a grain and another grain or a surface in a frame: a line of a force chain.
struct ReplayForce {
  std::size_t grain = 0;     ///< number of the grain, the same in all frames
  std::size_t partner = 0;   ///< number of the other grain or of the surface, likewise
  bool on_surface = false;   ///< what `partner` is
  Vec3 from = Vec3::Zero();  ///< m, where the line begins: in the grain's centre
  Vec3 to = Vec3::Zero();    ///< m, where it ends: in the other grain's centre, or where the grain touches the surface
  double force = 0.0;        ///< N, its size
};

/// A part of a machine.
struct ReplayPart {
  std::string name;
  io::SurfaceMesh mesh;
  template <class V>
  void fields(V& v) {
    v("name", name), v("mesh", mesh);
  }
};

/// What is kept of a grain in a frame: 28 bytes.
struct KeptGrain {
  std::uint32_t number : 31 = 0;
  std::uint32_t is_asleep : 1 = 0;
  std::array<float, 3> position = {};  ///< m, from the replay's origin
  std::uint32_t rotation = 0;          ///< pack_rotation
  float speed = 0.0F;                  ///< m/s
  float force = 0.0F;                  ///< N
};

/// What is kept of a force in a frame: 36 bytes.
struct KeptForce {
  std::uint32_t grain = 0;         ///< number
  std::uint32_t partner : 31 = 0;  ///< number
  std::uint32_t on_surface : 1 = 0;
  std::array<float, 3> from = {}, to = {};  ///< m, from the replay's origin
  float force = 0.0F;                       ///< N

  /// Tells which pair it is of.
  [[nodiscard]] std::uint64_t key() const {
    return std::uint64_t{grain} << 32U | std::uint64_t{on_surface} << 31U | partner;
  }
};

/// What is kept of a part in a frame: position (m, from the replay's origin) and quaternion (w, x, y, z), all zeros
/// where the part is not shown.
using KeptPose = std::array<float, 7>;

/// A frame of a replay.
struct KeptFrame {
  double time = 0.0;  ///< s
  std::vector<KeptGrain> grains = {};
  std::vector<KeptPose> poses = {};    ///< of the parts that there were at that time
  std::vector<KeptForce> forces = {};  ///< by their keys
  template <class V>
  void fields(V& v) {
    v("time", time, "s"), v.bytes("grains", grains), v.bytes("poses", poses), v.bytes("forces", forces);
  }
};

}  // namespace dem::report
