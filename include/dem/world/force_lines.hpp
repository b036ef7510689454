#pragma once

#include <dem/world/contact.hpp>

#include <algorithm>
#include <vector>

namespace dem {

/// What passes between a grain and another grain or a surface, through all points at which they touch.
struct ForceLine {
  Vec3 from;                     ///< m, centre of the grain
  Vec3 to;                       ///< m, centre of the other grain; on a surface the mean point, weighted by forces
  GrainId grain;                 ///< at `from`
  GrainId other_grain;           ///< at `to`, if it is a grain
  SurfaceId surface;             ///< at `to`, if it is a surface
  double normal_force = 0.0;     ///< N, sum over the points; positive where they push
  Vec3 force = Vec3::Zero();     ///< N, on the grain
  Vec3 friction = Vec3::Zero();  ///< N, the part of it that lies in the tangent planes
  double overlap = -HUGE_VAL;    ///< m, of the deepest point
  int points = 0;
};

/// Force chains: a line for each pair of partners that touch. Machine parts that touch each other have none. `contacts`
/// is what contacts_of(world) returned, in its order.
template <class Contacts>
std::vector<ForceLine> force_lines(const Contacts& contacts) {
  std::vector<ForceLine> lines;
  double weights = 0.0;
  for (const ContactForce& c : contacts) {
    if (c.kind == ContactKind::bodies) continue;
    const bool goes_on = !lines.empty() && lines.back().grain == c.grain && lines.back().other_grain == c.other_grain &&
                         lines.back().surface == c.surface;
    if (!goes_on) {
      lines.push_back({c.centre(), c.other_centre(), c.grain, c.other_grain, c.surface});
      weights = 0.0;
    }
    ForceLine& line = lines.back();
    line.normal_force += c.normal_force();
    line.force += c.force;
    line.friction += c.tangential_force();
    line.overlap = std::max(line.overlap, c.overlap);
    ++line.points;
    if (c.kind == ContactKind::grains) continue;
    const double size = c.force.norm(), sum = weights + size;
    line.to = weights == 0.0 ? c.point : Vec3(line.to + (size / sum) * (c.point - line.to));
    weights = sum;
  }
  return lines;
}

}  // namespace dem
