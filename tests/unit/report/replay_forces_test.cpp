#include "catch.hpp"
#include "core/error_of.hpp"
#include "inflate.hpp"

#include <dem/io/checkpoint/fields.hpp>
#include <dem/report/replay_encode.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace replay_forces_test {

using namespace dem::report;
using Catch::Approx;
using dem::Vec3;

namespace {

/// Forces of grains in a row far from the origin, with their neighbours and a floor. Some come late, leave, come back,
/// move, or change; grain 3 never does anything.
std::vector<ReplayForce> changing_forces(int frame) {
  std::vector<ReplayForce> forces;
  for (std::size_t n = 0; n < 40; ++n) {
    for (const bool on_surface : {true, false}) {
      const bool late = n % 7 == 2 && frame < 4, gone = n % 9 == 4 && frame > 6, away = n % 5 == 1 && frame % 3 == 1;
      if (late || gone || away) continue;
      const double still = n == 3 ? 0.0 : 1.0,
                   x = static_cast<double>(n) + still * 0.01 * std::sin(frame + 0.1 * static_cast<double>(n));
      forces.push_back({n, on_surface ? 7 : n + 1, on_surface, Vec3(50 + x, -20, 3),
                        on_surface ? Vec3(50 + x, -20, 2.5) : Vec3(51 + x, -20, 3 + 0.1 * still * frame),
                        1.0 + 0.1 * static_cast<double>(n) + (n % 2 == 0 ? still * 0.3 * frame : 0.0)});
    }
  }
  // The order in which they are given does not count.
  if (frame % 2 == 1) std::reverse(forces.begin(), forces.end());
  return forces;
}

}  // namespace

TEST_CASE("force chains can be read back from the bytes of a page, within the stated errors") {
  Replay replay({.frames = 12, .force_lines = 1000});
  for (int f = 0; f < 10; ++f) replay.record(f, {}, {}, changing_forces(f));
  replay.record(10.0, {}, {}, {});  // none at all in the last frame
  const EncodedReplay encoded = encode(replay);

  // They are the last in the stream, in which there is nothing else but a plane of grains that are not there.
  const ForcePlanes planes = force_planes(replay.frames());
  std::string expected;
  for (const std::string& plane : planes.bytes) expected += plane;
  CHECK(Inflate::all(encoded.bytes) == expected);
  CHECK_THAT(encoded.head, Catch::Matchers::ContainsSubstring(R"("forces":{"most":)"));
  CHECK(planes.most == Approx(1.0 + 3.8 + 2.7).epsilon(1e-6));  // of grain 38 in frame 9; kept in single precision

  ForceReader reader(planes);
  // Without grains the origin is that of the world: single precision leaves 4e-6 of numbers from 64 to 128.
  const Vec3 step = (planes.box.high - planes.box.low) / 131070 + Vec3::Constant(4e-6);
  std::size_t gone_or_new = 0;
  for (int f = 0; f < 10; ++f) {
    const auto& lines = reader.next();
    const auto forces = changing_forces(f);
    REQUIRE(lines.size() == forces.size());
    gone_or_new += planes.added[static_cast<std::size_t>(f)];
    for (const ReplayForce& force : forces) {
      const auto is_it = [&](const PackedForce& line) {
        for (int k = 0; k < 3; ++k) {
          const auto axis = static_cast<std::size_t>(k);
          const double from = unpack_coordinate(line.ends[axis], planes.box.low[k], planes.box.high[k]),
                       to = unpack_coordinate(line.ends[axis + 3], planes.box.low[k], planes.box.high[k]);
          if (std::abs(from + replay.origin()[k] - force.from[k]) > step[k]) return false;
          if (std::abs(to + replay.origin()[k] - force.to[k]) > step[k]) return false;
        }
        return std::abs(unpack_scalar(line.force, planes.most) - force.force) <=
               std::sqrt(force.force * planes.most) / 255 + planes.most / 260000;
      };
      CHECK(std::count_if(lines.begin(), lines.end(), is_it) == 1);
    }
  }
  CHECK(reader.next().empty());
  // What stays is told as a change: as new count the lines of the first frame, those that come late, and those that
  // come back in frames 2, 5 and 8 after they were away.
  CHECK(gone_or_new < 220);
  CHECK(planes.bytes[13].size() < 10 * 40 + 220);
}

TEST_CASE("of the forces of a frame the largest are kept, whatever the order in which they are given") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<ReplayForce> forces;
  for (std::size_t n = 0; n < 50; ++n) {
    forces.push_back({.grain = n,
                      .partner = 60,
                      .to = Vec3(0, 0, 1),
                      .force = n % 10 == 7 ? 5.0 : 1.0 + 0.01 * static_cast<double>(n)});
  }
  forces.push_back({.grain = 2, .partner = 61, .force = nan});
  forces.push_back({.grain = 3, .partner = 61, .from = Vec3(nan, 0, 0), .force = 9.0});
  forces.push_back({.grain = 4, .partner = 61, .force = 0.0});
  forces.push_back(
      {.grain = 17, .partner = 60, .force = 0.5});  // a second time, as with an image: the larger one counts
  const auto kept = [&](std::size_t lines) {
    Replay replay({.force_lines = lines});
    replay.record(0.0, {}, {}, forces);
    std::vector<std::uint32_t> grains;
    for (const KeptForce& f : replay.frames().at(0).forces) grains.push_back(f.grain);
    return grains;
  };
  CHECK(kept(3) == std::vector<std::uint32_t>{7, 17, 27});
  CHECK(kept(7) == std::vector<std::uint32_t>{7, 17, 27, 37, 47, 48, 49});
  CHECK(kept(100).size() == 50);
  CHECK(kept(0).empty());
  std::reverse(forces.begin(), forces.end());
  CHECK(kept(3) == std::vector<std::uint32_t>{7, 17, 27});

  // A page without forces says so.
  Replay none;
  none.record(0.0, {});
  CHECK_THAT(encode(none).head, Catch::Matchers::EndsWith(R"("forces":null})"));
  check_refused([&] { none.record(1.0, {}, {}, std::vector<ReplayForce>{{.grain = std::size_t{1} << 31U}}); },
                "number 2147483648", "from 0 on");
}

TEST_CASE("force chains of a replay that was kept in a file go on as if it had not been") {
  const ReplayOptions options = {.frames = 6, .force_lines = 30};
  Replay whole(options), first(options), second(options);
  for (int f = 0; f < 9; ++f) whole.record(f, {}, {}, changing_forces(f));
  for (int f = 0; f < 5; ++f) first.record(f, {}, {}, changing_forces(f));
  dem::io::StateColumns columns;
  dem::io::Fields collect(dem::io::Fields::Task::collect, columns);
  first.fields(collect);
  dem::io::Fields restore(dem::io::Fields::Task::restore, columns);
  second.fields(restore);
  restore.check_all_read();
  for (int f = 5; f < 9; ++f) second.record(f, {}, {}, changing_forces(f));
  CHECK(second.frames().back().forces.size() == 30);
  CHECK(encode(second).head == encode(whole).head);
  CHECK(encode(second).bytes == encode(whole).bytes);
}

}  // namespace replay_forces_test
