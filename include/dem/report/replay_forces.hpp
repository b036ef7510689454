#pragma once
// The force chains of a replay as differences from frame to frame, each kind of byte for itself.

#include <dem/report/quantise.hpp>
#include <dem/report/replay_data.hpp>
#include <dem/report/replay_planes.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::report {

/// A line of a frame, quantised: three coordinates where it begins, three where it ends (pack_coordinate in the box of
/// all lines), and its force (pack_scalar).
struct PackedForce {
  std::array<std::uint16_t, 6> ends = {};
  std::uint8_t force = 0;

  bool operator==(const PackedForce&) const = default;
};

/// The bytes of all lines of all frames. A frame begins with the lines of the frame before, in the order that they had
/// there. Plane 0 says of each: 0 it is gone, or 1, and added to it 2 if it has moved, 4 if its force has changed.
/// Behind those that stay stand the new ones, as if they had been where the new line before them is (the first one: in
/// the low corner of the box) with a force of 0, and its end where its beginning is. What has changed is in the other
/// planes as differences with their sign in the lowest bit: low and high bytes of the six coordinates (1 to 12), and
/// the force (13).
struct ForcePlanes {
  std::array<std::string, 14> bytes = {};
  std::vector<std::size_t> added = {};  ///< new lines of each frame
  Box box = {};                         ///< of all lines (m, from the replay's origin)
  double most = 0.0;                    ///< N, the largest force
};

namespace detail {

inline void add_force(ForcePlanes& planes, const PackedForce& now, const PackedForce& before) {
  const bool moved = now.ends != before.ends, other = now.force != before.force;
  planes.bytes[0] += byte(1U + (moved ? 2U : 0U) + (other ? 4U : 0U));
  for (std::size_t k = 0; moved && k < 6; ++k) {
    const std::uint32_t d = fold(now.ends[k], before.ends[k], 16);
    planes.bytes[1 + 2 * k] += byte(d);
    planes.bytes[2 + 2 * k] += byte(d >> 8U);
  }
  if (other) planes.bytes[13] += byte(fold(now.force, before.force, 8));
}

}  // namespace detail

/// All lines of the frames, quantised and as differences.
[[nodiscard]] inline ForcePlanes force_planes(std::span<const KeptFrame> frames) {
  ForcePlanes planes;
  bool first = true;
  for (const KeptFrame& frame : frames) {
    for (const KeptForce& f : frame.forces) {
      planes.most = std::max<double>(planes.most, f.force);
      for (const auto& end : {f.from, f.to}) {
        const Vec3 x(end[0], end[1], end[2]);
        planes.box.low = first ? x : Vec3(planes.box.low.cwiseMin(x));
        planes.box.high = first ? x : Vec3(planes.box.high.cwiseMax(x));
        first = false;
      }
    }
  }
  struct Line {
    std::uint64_t key;
    PackedForce packed;
  };
  const auto pack = [&](const KeptForce& f) {
    PackedForce packed;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      packed.ends[axis] = pack_coordinate(f.from[axis], planes.box.low[k], planes.box.high[k]);
      packed.ends[axis + 3] = pack_coordinate(f.to[axis], planes.box.low[k], planes.box.high[k]);
    }
    packed.force = pack_scalar(f.force, planes.most);
    return packed;
  };
  std::vector<Line> last, now;
  std::vector<bool> stays;
  for (const KeptFrame& frame : frames) {
    now.clear();
    stays.assign(frame.forces.size(), false);
    for (const Line& line : last) {
      const auto found = std::lower_bound(frame.forces.begin(), frame.forces.end(), line.key,
                                          [](const KeptForce& f, std::uint64_t key) { return f.key() < key; });
      if (found == frame.forces.end() || found->key() != line.key) {
        planes.bytes[0] += detail::byte(0);
        continue;
      }
      now.push_back({line.key, pack(*found)});
      detail::add_force(planes, now.back().packed, line.packed);
      stays[static_cast<std::size_t>(found - frame.forces.begin())] = true;
    }
    planes.added.push_back(frame.forces.size() - now.size());
    PackedForce before;
    for (std::size_t k = 0; k < frame.forces.size(); ++k) {
      if (stays[k]) continue;
      now.push_back({frame.forces[k].key(), pack(frame.forces[k])});
      const PackedForce& packed = now.back().packed;
      for (std::size_t axis = 0; axis < 3; ++axis) before.ends[axis + 3] = packed.ends[axis];
      detail::add_force(planes, packed, before);
      for (std::size_t axis = 0; axis < 3; ++axis) before.ends[axis] = packed.ends[axis];
    }
    std::swap(last, now);
  }
  return planes;
}

/// Reads back what force_planes has written, frame after frame: what the page does, for tests.
class ForceReader {
 public:
  explicit ForceReader(ForcePlanes planes) : planes_(std::move(planes)) {}

  /// The lines of the next frame.
  const std::vector<PackedForce>& next() {
    std::vector<PackedForce> now;
    for (const PackedForce& line : lines_) {
      if (const std::uint32_t what = take(0); what != 0) now.push_back(read(what, line, false));
    }
    PackedForce before;
    for (std::size_t k = 0; k < planes_.added.at(frame_); ++k) {
      now.push_back(read(take(0), before, true));
      for (std::size_t axis = 0; axis < 3; ++axis) before.ends[axis] = now.back().ends[axis];
    }
    ++frame_;
    lines_ = std::move(now);
    return lines_;
  }

 private:
  std::uint32_t take(std::size_t plane) { return static_cast<unsigned char>(planes_.bytes[plane].at(at_[plane]++)); }

  PackedForce read(std::uint32_t what, PackedForce line, bool is_new) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (is_new && k >= 3) line.ends[k] = line.ends[k - 3];
      if ((what & 2U) == 0) continue;
      const std::uint32_t low = take(1 + 2 * k), high = take(2 + 2 * k);
      line.ends[k] = static_cast<std::uint16_t>(detail::unfold(low | high << 8U, line.ends[k], 16));
    }
    if ((what & 4U) != 0) line.force = static_cast<std::uint8_t>(detail::unfold(take(13), line.force, 8));
    return line;
  }

  ForcePlanes planes_;
  std::array<std::size_t, 14> at_ = {};
  std::vector<PackedForce> lines_;
  std::size_t frame_ = 0;
};

}  // namespace dem::report
