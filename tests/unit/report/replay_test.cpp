#include "catch.hpp"
#include "core/error_of.hpp"
#include "inflate.hpp"

#include <dem/io/checkpoint/fields.hpp>
#include <dem/report/replay_encode.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace replay_test {

using namespace dem::report;
using Catch::Approx;
using dem::Mat3;
using dem::Vec3;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ReplayShape ball(double radius) { return {.balls = {{Vec3::Zero(), radius}}, .mesh = {}, .smooth_angle = 0.0}; }
ReplayShape cube(double edge) {
  return {.balls = {}, .mesh = dem::io::box_mesh({edge, edge, edge}), .smooth_angle = 0.0};
}

Mat3 turned(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }

/// The number behind `"name":` in a head, or the numbers of a list.
std::vector<double> numbers_of(const std::string& head, const std::string& name, std::size_t from = 0) {
  std::size_t at = head.find("\"" + name + "\":", from);
  REQUIRE(at != std::string::npos);
  at += name.size() + 3;
  std::vector<double> numbers;
  const std::string list =
      head[at] == '[' ? head.substr(at + 1, head.find(']', at) - at - 1) + "," : head.substr(at) + ",";
  for (std::size_t k = 0; k < list.size();) {
    std::size_t used = 0;
    numbers.push_back(std::stod(list.substr(k), &used));
    k += used + 1;
    if (head[at] != '[') break;
  }
  return numbers;
}

/// Grains that tumble about, some of which come late, leave, or come back.
std::vector<ReplayGrain> tumbling(int frame) {
  std::vector<ReplayGrain> grains;
  for (std::size_t n = 0; n < 60; ++n) {
    const bool late = n % 7 == 3 && frame < 5, gone = n % 11 == 4 && frame > 12, away = n % 5 == 1 && frame % 4 == 2;
    if (late || gone || away) continue;
    const double a = 0.7 * static_cast<double>(n), t = 0.3 * frame;
    const bool still = n % 3 == 0;
    ReplayGrain g{.number = n, .shape = n % 2};
    g.position = {100.0 + std::sin(a) + (still ? 0.0 : 0.1 * std::sin(t + a)), std::cos(3 * a),
                  still ? 1.0 : 1.0 - 0.02 * t * t};
    g.rotation = still ? Mat3(Mat3::Identity()) : turned(t * (1.0 + a), Vec3(1, std::sin(a), std::cos(a)));
    g.speed = still ? 0.0 : 0.04 * t;
    g.force = 5.0 + std::sin(t * a);
    g.is_asleep = still && frame > 8;
    grains.push_back(g);
  }
  return grains;
}

}  // namespace

TEST_CASE("differences wrap around and come back") {
  for (std::uint32_t before = 0; before < 256; before += 5) {
    for (std::uint32_t now = 0; now < 256; ++now) {
      const std::uint32_t d = detail::fold(now, before, 8);
      REQUIRE(d < 256);
      REQUIRE(detail::unfold(d, before, 8) == now);
    }
  }
  CHECK(detail::fold(7, 5, 16) == 4);
  CHECK(detail::fold(5, 7, 16) == 3);
  CHECK(detail::fold(0, 65535, 16) == 2);
  CHECK(detail::unfold(detail::fold(32768, 0, 16), 0, 16) == 32768);
}

TEST_CASE("all that a page holds of a run can be read back, within the stated errors") {
  Replay replay({.frames = 20});
  replay.add_shape(ball(0.1));
  replay.add_shape(cube(0.2));
  CHECK(replay.add_shape(ball(0.1)) == 0);  // held twins of grains look as these do
  CHECK(replay.add_shape(cube(0.2)) == 1);
  replay.add_part("lid", dem::io::box_mesh({1, 2, 3}));
  replay.add_part("\"wheel\" </script>", dem::io::cylinder_mesh(0.5, 0.2));
  const auto lid = [](int f) {
    return ReplayPose{.position = {100, 0, 0.1 * f}, .rotation = turned(0.1 * f, Vec3::UnitX()), .shown = f != 3};
  };
  const ReplayPose wheel{.position = {101, 0, 0}, .rotation = turned(1, Vec3(1, 2, 3))};
  for (int f = 0; f < 20; ++f) {
    const std::vector<ReplayPose> poses = {lid(f), wheel};
    replay.record(0.5 * f, tumbling(f), poses);
  }

  const EncodedReplay encoded = encode(replay);
  CHECK(encoded.head.find('<') == std::string::npos);
  CHECK(encoded.head.find("\"sleep\":true") != std::string::npos);
  CHECK_THAT(encoded.head, Catch::Matchers::ContainsSubstring(R"("name":"\u0022wheel\u0022 \u003c/script>")"));
  CHECK(numbers_of(encoded.head, "times").at(19) == 9.5);
  CHECK(numbers_of(encoded.head, "seen").at(0) == 60);
  const std::string bytes = Inflate::all(encoded.bytes);

  // The meshes of the two shapes come first: a coordinate takes three bytes, an index four.
  std::size_t at = 0;
  const std::size_t second = encoded.head.find("},{\"grains\":");
  for (const std::size_t from : {std::size_t{0}, second}) {
    at += static_cast<std::size_t>(9 * numbers_of(encoded.head, "vertices", from)[0] +
                                   4 * numbers_of(encoded.head, "corners", from)[0]);
  }
  CHECK(numbers_of(encoded.head, "corners", second)[0] == 36);
  ReplayPlanes planes;
  const std::vector<double> sizes = numbers_of(encoded.head, "planes");
  REQUIRE(sizes.size() == planes.bytes.size());
  for (std::size_t p = 0; p < sizes.size(); ++p) {
    planes.bytes[p] = bytes.substr(at, static_cast<std::size_t>(sizes[p]));
    at += planes.bytes[p].size();
  }

  const ReplayTable table = replay_table(replay);
  REQUIRE(table.counts == std::vector<std::size_t>{30, 30});
  CHECK(table.numbers.front() == 0);
  CHECK(table.numbers.at(30) == 1);  // the first of the other shape
  PlaneReader reader(planes, table.numbers.size());
  // Single precision, from an origin at the grains, adds 1e-7.
  const Vec3 step = (table.box.high - table.box.low) / 131070 + Vec3::Constant(1e-7);
  for (int f = 0; f < 20; ++f) {
    const auto& packed = reader.next();
    const auto grains = tumbling(f);
    std::size_t present = 0;
    for (std::size_t k = 0; k < packed.size(); ++k) present += packed[k].present ? 1 : 0;
    REQUIRE(present == grains.size());
    for (const ReplayGrain& g : grains) {
      const auto row = static_cast<std::size_t>(std::find(table.numbers.begin(), table.numbers.end(), g.number) -
                                                table.numbers.begin());
      const PackedGrain& p = packed.at(row);
      REQUIRE(p.present);
      CHECK(p.asleep == g.is_asleep);
      for (int k = 0; k < 3; ++k) {
        const double x = replay.origin()[k] + unpack_coordinate(p.position[static_cast<std::size_t>(k)],
                                                                table.box.low[k], table.box.high[k]);
        CHECK(std::abs(x - g.position[k]) < step[k]);
      }
      const auto q = unpack_rotation(p.rotation), exact = quaternion_of(g.rotation);
      const double cosine = std::abs(q[0] * exact[0] + q[1] * exact[1] + q[2] * exact[2] + q[3] * exact[3]);
      CHECK(2 * std::acos(std::min(1.0, cosine)) < 4.9e-3);
      CHECK(std::abs(unpack_scalar(p.scalars[0], table.most_speed) - g.speed) <=
            std::sqrt(g.speed * table.most_speed) / 255 + table.most_speed / 260000);
      CHECK(std::abs(unpack_scalar(p.scalars[1], table.most_force) - g.force) <=
            std::sqrt(g.force * table.most_force) / 255 + table.most_force / 260000);
    }
  }

  // The parts: a mesh, and then its poses in single precision.
  const auto floats = [&](std::size_t from, std::size_t count) {
    std::vector<float> values(count);
    std::memcpy(values.data(), bytes.substr(from, 4 * count).data(), 4 * count);
    return values;
  };
  const std::size_t lid_head = encoded.head.find("\"lid\""), wheel_head = encoded.head.find("wheel");
  CHECK(numbers_of(encoded.head, "poses", lid_head)[0] == 20);
  CHECK(numbers_of(encoded.head, "poses", wheel_head)[0] == 1);  // it stands still
  const auto mesh_bytes = [&](std::size_t from) {
    return static_cast<std::size_t>(9 * numbers_of(encoded.head, "vertices", from)[0] +
                                    4 * numbers_of(encoded.head, "corners", from)[0]);
  };
  at += mesh_bytes(lid_head);
  const std::vector<float> poses = floats(at, 7 * 20);
  for (int f = 0; f < 20; ++f) {
    const auto q = quaternion_of(lid(f).rotation);
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = lid(f).position[static_cast<int>(k)] - replay.origin()[static_cast<int>(k)];
      CHECK(poses[static_cast<std::size_t>(7 * f) + k] == (f == 3 ? 0.0F : static_cast<float>(x)));
    }
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(poses[static_cast<std::size_t>(7 * f) + 3 + k] == (f == 3 ? 0.0F : static_cast<float>(q[k])));
    }
  }
  at += 4 * 7 * 20 + mesh_bytes(wheel_head) + 4 * 7;
  CHECK(at == bytes.size());
}

TEST_CASE("grains at rest cost next to nothing") {
  Replay replay({.frames = 200});
  replay.add_shape(cube(0.1));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(0, 1);
  std::vector<ReplayGrain> grains;
  for (std::size_t n = 0; n < 1000; ++n) {
    const Vec3 x(anywhere(random), anywhere(random), anywhere(random));
    grains.push_back({n, 0, x, turned(x.x(), x), 0.0, x.y()});
  }
  replay.record(0.0, grains);
  const std::size_t one = encode(replay).bytes.size();
  for (int f = 1; f < 200; ++f) replay.record(f, grains);
  const std::size_t all = encode(replay).bytes.size();
  // Plane 0 alone grows, by 199,000 equal bytes: 772 runs of two or three bits, and 6 heads of blocks of 20 bytes.
  CHECK(all - one < 772 * 3 / 8 + 6 * 20);
  // In the first frame 6 bytes of place, 4 of rotation and 1 of force; 11 codes of up to 256 symbols, and a mesh.
  CHECK(one < 1000 * 11 + 11 * 150 + 500);
}

TEST_CASE("balls have their volume, and are finer where there are few") {
  for (const std::size_t balls : {1, 500, 501, 8'000, 8'001, 32'000, 32'001, 128'000}) {
    const int level = detail::ball_refinements(balls);
    CHECK(balls * detail::ball_mesh({{Vec3::Zero(), 1.0}}, level).triangles.size() / 3 <= 2'560'000);
  }
  CHECK(detail::ball_refinements(1) == 3);
  CHECK(detail::ball_refinements(80'000) == 0);
  const auto volume = [](const detail::ReplayMesh& m) {
    double sum = 0.0;
    for (std::size_t k = 0; k < m.triangles.size(); k += 3) {
      sum += m.vertices[m.triangles[k]].dot(m.vertices[m.triangles[k + 1]].cross(m.vertices[m.triangles[k + 2]])) / 6;
    }
    return sum;
  };
  for (int level = 0; level <= 3; ++level) {
    CHECK(volume(detail::ball_mesh({{Vec3(1, 2, 3), 2.0}}, level)) == Approx(4.0 / 3 * 3.14159265358979 * 8));
  }
  // Of a ball within another one no triangle is left; two that overlap lose what nobody sees.
  CHECK(detail::ball_mesh({{Vec3::Zero(), 2.0}, {Vec3::Zero(), 1.0}}, 2).triangles.size() == 3 * 320);
  const auto two = detail::ball_mesh({{Vec3(-0.4, 0, 0), 1.0}, {Vec3(0.4, 0, 0), 1.0}}, 3).triangles.size();
  CHECK(two < 2 * 3 * 1280);
  CHECK(two > 3 * 1280);
}

TEST_CASE("faces with many corners become triangles") {
  const auto mesh = detail::triangulated({.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}},
                                          .triangles = {{0, 1, 2}},
                                          .quads = {{0, 1, 2, 3}},
                                          .polygons = {{0, 1, 2, 3, 4}}},
                                         0.5);
  CHECK(mesh.triangles == std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3, 0, 3, 4});
}

TEST_CASE("what has a number that is not finite in single precision is not drawn, and the rest is") {
  constexpr double huge = 1e39;
  Replay replay;
  replay.add_shape(ball(0.1));
  for (int k = 0; k < 4; ++k) replay.add_part("", dem::io::box_mesh({1, 1, 1}));
  std::vector<ReplayGrain> grains(7);
  for (std::size_t n = 0; n < grains.size(); ++n) grains[n].number = n;
  grains[0].position.x() = -1e200;  // the middle of the first frame is not drawn off by it
  grains[1].position.x() = kNan;
  grains[2].rotation(0, 0) = kNan;
  grains[3].force = std::numeric_limits<double>::infinity();
  grains[4].speed = huge;
  grains[5].force = huge;
  std::vector<ReplayPose> poses(4);
  poses[1].position.z() = huge;
  poses[2].rotation(1, 2) = kNan;
  poses[3].position.y() = 2.0;
  const std::vector<ReplayForce> forces = {{.grain = 6, .partner = 1, .force = 1.0},
                                           {.grain = 6, .partner = 2, .force = huge},
                                           {.grain = 6, .partner = 3, .to = Vec3(0, 0, -huge), .force = 2.0}};
  replay.record(0.0, grains, poses, forces);
  const KeptFrame& frame = replay.frames().at(0);
  REQUIRE(frame.grains.size() == 1);
  CHECK(frame.grains[0].number == 6);
  CHECK(frame.poses == std::vector<KeptPose>{{0, 0, 0, 1, 0, 0, 0}, KeptPose{}, KeptPose{}, {0, 2, 0, 1, 0, 0, 0}});
  REQUIRE(frame.forces.size() == 1);
  CHECK(frame.forces[0].partner == 1);
  CHECK(replay_table(replay).numbers == std::vector<std::uint32_t>{6});
  const EncodedReplay encoded = encode(replay);
  CHECK(encoded.bytes.size() > 100);
  CHECK(encoded.head.find("inf") == std::string::npos);
  CHECK(encoded.head.find("nan") == std::string::npos);
}

TEST_CASE("of too many grains those that are drawn are in all frames, old ones too") {
  Replay replay({.grains = 100});
  replay.add_shape(ball(0.1));
  std::vector<ReplayGrain> grains;
  for (int f = 0; f < 5; ++f) {
    for (int k = 0; k < 80; ++k) grains.push_back({.number = grains.size(), .position = Vec3::Constant(f)});
    replay.record(f, grains);
  }
  const ReplayTable table = replay_table(replay);
  CHECK(table.numbers.size() <= 100);
  CHECK(table.numbers.size() > 90);
  CHECK(numbers_of(encode(replay).head, "seen")[0] == 400);
  PlaneReader reader(replay_planes(replay, table), table.numbers.size());
  for (int f = 0; f < 5; ++f) {
    const auto& packed = reader.next();
    for (std::size_t k = 0; k < packed.size(); ++k) {
      CHECK(packed[k].present == (table.numbers[k] < 80U * static_cast<unsigned>(f + 1)));
    }
  }
}

TEST_CASE("what cannot be recorded is refused in words") {
  check_refused([] { Replay({.frames = 1}); }, "given 1 frames", "2 to 10000");
  check_refused([] { Replay({.frames = 20'000}); }, "given 20000 frames");
  check_refused([] { Replay({.interval = -1}); }, "time between frames of a replay", "-1 s");
  check_refused([] { Replay({.grains = 0}); }, "0 grains");
  check_refused([] { Replay({.plane_size = 0}); }, "edge of a plane in a replay");

  Replay replay;
  check_refused([&] { replay.add_shape(ball(0.0)); }, "radius of a ball in a replay is 0 m");
  check_refused([&] { replay.add_shape({}); }, "shape 0 has no faces");
  check_refused(
      [&] {
        replay.add_part("lid", {.vertices = {Vec3::Zero()}, .triangles = {{0, 0, 1}}});
      },
      "a face of part 'lid' uses vertex 1", "its mesh has 1");
  check_refused(
      [&] {
        replay.add_part("lid", {.vertices = {Vec3(kNan, 0, 0)}, .triangles = {{0, 0, 0}}});
      },
      "part 'lid'", "not finite");
  check_refused([&] { (void)encode(replay); }, "has no frames", "call record()");

  replay.add_shape(ball(1.0));
  replay.add_shape(ball(2.0));
  const std::vector<ReplayGrain> grains = {{.number = 3, .shape = 1}};
  check_refused([&] { replay.record(kNan, grains); }, "time of a frame is nan");
  check_refused([&] { replay.record(0.0, std::vector<ReplayGrain>{{.number = 3, .shape = 2}}); }, "grain 3 has shape 2",
                "2 were added");
  check_refused([&] { replay.record(0.0, std::vector<ReplayGrain>{{.number = std::size_t{1} << 32U, .shape = 0}}); },
                "number 4294967296");
  replay.record(1.0, grains);
  check_refused([&] { replay.record(0.5, grains); }, "a frame at 0.5 s after one at 1 s");
  check_refused([&] { replay.record(2.0, std::vector<ReplayGrain>{{.number = 3, .shape = 0}}); },
                "grain 3 has shape 0, but had 1 before");
  replay.add_part("", dem::io::box_mesh({1, 1, 1}));
  CHECK(replay.parts().at(0).name == "part 1");
  check_refused([&] { replay.record(2.0, grains); }, "0 poses, but there are 1 parts");
  CHECK(replay.frames().size() == 1);
  // The part was not there in the first frame.
  replay.record(2.0, grains, std::vector<ReplayPose>(1));
  CHECK(numbers_of(encode(replay).head, "poses")[0] == 2);
}

TEST_CASE("a replay that was kept in a file goes on as if it had not been") {
  const auto add_looks = [](Replay& replay) {
    replay.add_shape(ball(0.1));
    replay.add_shape(cube(0.2));
    replay.add_part("lid", dem::io::box_mesh({1, 2, 3}));
  };
  const auto record = [](Replay& replay, int from, int to) {
    for (int f = from; f < to; ++f) {
      replay.record(0.5 * f, tumbling(f), std::vector<ReplayPose>{{.position = {100, 0, 0.1 * f}}});
    }
  };
  const ReplayOptions options = {
      .frames = 12, .interval = 0.5, .grains = 40};  // every second frame is dropped on the way
  Replay whole(options), first(options), second(options);
  add_looks(whole), add_looks(first);
  record(whole, 0, 20);
  record(first, 0, 15);
  dem::io::StateColumns columns;
  dem::io::Fields collect(dem::io::Fields::Task::collect, columns);
  first.fields(collect);
  dem::io::Fields restore(dem::io::Fields::Task::restore, columns);
  second.fields(restore);
  restore.check_all_read();
  CHECK(encode(second).bytes == encode(first).bytes);
  record(second, 15, 20);
  CHECK(encode(second).head == encode(whole).head);
  CHECK(encode(second).bytes == encode(whole).bytes);
}

}  // namespace replay_test
