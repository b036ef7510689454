#pragma once
// A replay as what a page holds of it: a head to read, and bytes.

#include <dem/report/deflate.hpp>
#include <dem/report/replay_forces.hpp>
#include <dem/report/replay_mesh.hpp>
#include <dem/report/replay_planes.hpp>
#include <dem/report/replay_recorder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dem::report {

/// The grains that are drawn, shape after shape, and the numbers that all frames share.
struct ReplayTable {
  std::vector<std::uint32_t> numbers = {};  ///< of the grains, in the order in which they stand in a packed frame
  std::vector<std::size_t> counts = {};     ///< how many of them each shape has
  Box box = {};                             ///< of all centres in all frames (m, from the replay's origin)
  double most_speed = 0.0;                  ///< m/s, in all frames
  double most_force = 0.0;                  ///< N, likewise
  bool any_asleep = false;                  ///< in any frame
};

/// What a page holds of a replay. `head` is JSON; it says how to read `bytes`, a zlib stream of numbers, their lowest
/// byte first. As text in a page 9,584 cubes that fall into a box and are pushed about in 100 frames take 2.9 MB, and
/// 10,000 balls that all shake and tumble all the time 8 MB; packed numbers without differences would take 15 MB.
struct EncodedReplay {
  std::string head, bytes;
};

/// Throws dem::Error when no frame was recorded.
[[nodiscard]] inline ReplayTable replay_table(const Replay& replay) {
  if (replay.frames().empty()) fail("the replay has no frames; call record() before it is put into a report");
  ReplayTable table;
  std::vector<bool> found(replay.sample().numbers(), false);
  bool first = true;
  for (const KeptFrame& frame : replay.frames()) {
    for (const KeptGrain& g : frame.grains) {
      if (!replay.sample().draws(g.number)) continue;
      found[g.number] = true;
      const Vec3 x(g.position[0], g.position[1], g.position[2]);
      table.box.low = first ? x : Vec3(table.box.low.cwiseMin(x));
      table.box.high = first ? x : Vec3(table.box.high.cwiseMax(x));
      first = false;
      table.most_speed = std::max<double>(table.most_speed, g.speed);
      table.most_force = std::max<double>(table.most_force, g.force);
      table.any_asleep = table.any_asleep || g.is_asleep != 0;
    }
  }
  for (std::size_t shape = 0; shape < replay.shapes().size(); ++shape) {
    const std::size_t before = table.numbers.size();
    for (std::size_t n = 0; n < found.size(); ++n) {
      if (found[n] && replay.sample().shape_of(n) == shape) table.numbers.push_back(static_cast<std::uint32_t>(n));
    }
    table.counts.push_back(table.numbers.size() - before);
  }
  return table;
}

/// All frames, quantised and as differences.
[[nodiscard]] inline ReplayPlanes replay_planes(const Replay& replay, const ReplayTable& table) {
  std::vector<std::uint32_t> row(replay.sample().numbers(), GrainSample::kUnmet);
  for (std::size_t k = 0; k < table.numbers.size(); ++k) row[table.numbers[k]] = static_cast<std::uint32_t>(k);
  ReplayPlanes planes;
  std::vector<PackedGrain> now(table.numbers.size()), before(table.numbers.size());
  for (const KeptFrame& frame : replay.frames()) {
    std::fill(now.begin(), now.end(), PackedGrain{});
    for (const KeptGrain& g : frame.grains) {
      if (!replay.sample().draws(g.number)) continue;
      PackedGrain& packed = now[row[g.number]];
      for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        packed.position[axis] = pack_coordinate(g.position[axis], table.box.low[k], table.box.high[k]);
      }
      packed.rotation = g.rotation;
      packed.scalars = {pack_scalar(g.speed, table.most_speed), pack_scalar(g.force, table.most_force)};
      packed.present = true;
      packed.asleep = g.is_asleep != 0;
    }
    add_frame(planes, now, before);
  }
  return planes;
}

namespace detail {

/// Numbers as folded differences, `bytes` bytes each, byte by byte.
inline void add_words(Deflate& out, std::span<const std::uint32_t> words, unsigned bytes) {
  std::vector<std::string> planes(bytes);
  std::uint32_t before = 0;
  for (const std::uint32_t word : words) {
    const auto d = static_cast<std::int32_t>(word - before);
    const std::uint32_t folded = d < 0 ? 2U * ~static_cast<std::uint32_t>(d) + 1U : 2U * static_cast<std::uint32_t>(d);
    for (unsigned k = 0; k < bytes; ++k) planes[k] += byte(folded >> 8 * k);
    before = word;
  }
  for (const std::string& plane : planes) out.add(plane);
}

/// A mesh: coordinates in 65,536 steps of its own box, x, y and z after each other, then indices. Returns its head.
inline std::string add_mesh(Deflate& out, const ReplayMesh& mesh) {
  Box box{.low = mesh.vertices.front(), .high = mesh.vertices.front()};
  for (const Vec3& v : mesh.vertices) {
    box.low = box.low.cwiseMin(v);
    box.high = box.high.cwiseMax(v);
  }
  for (int k = 0; k < 3; ++k) {
    std::vector<std::uint32_t> steps;
    for (const Vec3& v : mesh.vertices) steps.push_back(pack_coordinate(v[k], box.low[k], box.high[k]));
    add_words(out, steps, 3);
  }
  add_words(out, mesh.triangles, 4);
  return fmt::format(
      R"("vertices":{},"corners":{},"smooth":{:.4g},"low":[{:.9g},{:.9g},{:.9g}],"high":[{:.9g},{:.9g},{:.9g}])",
      mesh.vertices.size(), mesh.triangles.size(), mesh.smooth_angle, box.low.x(), box.low.y(), box.low.z(),
      box.high.x(), box.high.y(), box.high.z());
}

/// The poses of a part: one if it never moves, else one a frame, seven single-precision numbers each.
inline std::string add_poses(Deflate& out, const Replay& replay, std::size_t part) {
  std::vector<KeptPose> poses;
  for (const KeptFrame& frame : replay.frames()) {
    poses.push_back(part < frame.poses.size() ? frame.poses[part] : KeptPose{});
  }
  const bool still = std::all_of(poses.begin(), poses.end(), [&](const KeptPose& p) { return p == poses.front(); });
  if (still) poses.resize(1);
  std::string bytes;
  for (const KeptPose& pose : poses) {
    for (const float value : pose) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (unsigned k = 0; k < 4; ++k) bytes += byte(bits >> 8 * k);
    }
  }
  out.add(bytes);
  return fmt::format(R"("poses":{})", poses.size());
}

/// The force chains: how to read them, as JSON; null if there are none.
inline std::string add_forces(Deflate& out, const Replay& replay) {
  const ForcePlanes planes = force_planes(replay.frames());
  if (planes.most == 0.0) return "null";
  const Box& box = planes.box;
  std::string head =
      fmt::format(R"({{"most":{:.9g},"low":[{:.9g},{:.9g},{:.9g}],"high":[{:.9g},{:.9g},{:.9g}],"added":[)",
                  planes.most, box.low.x(), box.low.y(), box.low.z(), box.high.x(), box.high.y(), box.high.z());
  const char* comma = "";
  for (const std::size_t count : planes.added) {
    head += fmt::format("{}{}", comma, count);
    comma = ",";
  }
  head += "],\"planes\":[";
  comma = "";
  for (const std::string& plane : planes.bytes) {
    out.add(plane);
    head += fmt::format("{}{}", comma, plane.size());
    comma = ",";
  }
  return head + "]}";
}

/// A string of JSON that may stand inside a page: no "<".
[[nodiscard]] inline std::string json_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const bool plain = static_cast<unsigned char>(c) >= 0x20U && c != '"' && c != '\\' && c != '<';
    result += plain ? std::string(1, c) : fmt::format("\\u{:04x}", static_cast<unsigned>(c) & 0xffU);
  }
  return result + '"';
}

}  // namespace detail

/// Makes what the page needs. Throws dem::Error when no frame was recorded.
[[nodiscard]] inline EncodedReplay encode(const Replay& replay) {
  const ReplayTable table = replay_table(replay);
  const ReplayPlanes planes = replay_planes(replay, table);
  Deflate out;
  std::string head =
      fmt::format(R"({{"grains":{},"seen":{},"low":[{:.9g},{:.9g},{:.9g}],"high":[{:.9g},{:.9g},{:.9g}],)",
                  table.numbers.size(), replay.sample().met(), table.box.low.x(), table.box.low.y(), table.box.low.z(),
                  table.box.high.x(), table.box.high.y(), table.box.high.z());
  head += fmt::format(R"("speed":{:.9g},"force":{:.9g},"sleep":{},"shapes":[)", table.most_speed, table.most_force,
                      table.any_asleep);
  const char* comma = "";
  for (std::size_t s = 0; s < replay.shapes().size(); ++s) {
    const auto mesh = detail::shape_mesh(replay.shapes()[s], table.counts[s]);
    head += fmt::format("{}{{\"grains\":{},{}}}", comma, table.counts[s], detail::add_mesh(out, mesh));
    comma = ",";
  }
  head += "],\"planes\":[";
  comma = "";
  for (const std::string& plane : planes.bytes) {
    out.add(plane);
    head += fmt::format("{}{}", comma, plane.size());
    comma = ",";
  }
  head += "],\"parts\":[";
  comma = "";
  for (std::size_t p = 0; p < replay.parts().size(); ++p) {
    const ReplayPart& part = replay.parts()[p];
    const std::string mesh = detail::add_mesh(out, detail::triangulated(part.mesh, 0.6));
    head += fmt::format("{}{{\"name\":{},{},{}}}", comma, detail::json_text(part.name), mesh,
                        detail::add_poses(out, replay, p));
    comma = ",";
  }
  head += "],\"times\":[";
  comma = "";
  for (const KeptFrame& frame : replay.frames()) {
    head += fmt::format("{}{:.9g}", comma, frame.time);
    comma = ",";
  }
  head += "],\"forces\":" + detail::add_forces(out, replay);
  return {.head = head + "}", .bytes = out.finish()};
}

}  // namespace dem::report
