#pragma once
// Images of grains beyond the borders of a periodic cell: rows of their own behind those of the grains, which contacts
// read as they read any partner. Their loads go to the grains that they are images of.

#include <dem/domain/open.hpp>
#include <dem/grain/grain_columns.hpp>

#include <cstdint>
#include <type_traits>
#include <vector>

namespace dem::grain {

/// Of a world without borders: every row is a grain.
struct NoImages {
  static constexpr std::uint32_t grain_of(std::uint32_t row) { return row; }
  static constexpr bool may_pair(std::size_t, std::uint32_t) { return true; }
};

/// Which grain (row) each image row shows, and how far away from it.
struct ImageRows {
  std::uint32_t grains = 0;            ///< rows of grains; then come padding rows
  std::uint32_t first = 0xffffffffu;   ///< the first row of an image
  std::vector<std::uint32_t> grain;    ///< row of the grain, ascending
  std::vector<Vector3<double>> shift;  ///< m, from the grain to its image
  std::vector<std::int32_t> level;     ///< of a sheared cell: how many cells above the grain's
  double offset = 0.0;                 ///< m, of a sheared cell when they were listed

  std::uint32_t grain_of(std::uint32_t row) const { return row < first ? row : grain[row - first]; }
  /// Whether row j is a partner that grain i looks after: of two grains that meet across a border, the one with the
  /// lower row.
  bool may_pair(std::size_t i, std::uint32_t j) const { return j < grains || (j >= first && grain[j - first] > i); }
};

template <class Domain>
using Images = std::conditional_t<Domain::has_images, ImageRows, NoImages>;

/// Puts the images where their grains are now.
template <class GrainColumns, class Domain>
void follow_grain(GrainColumns& p, const ImageRows& images, const Domain& domain, std::size_t image) {
  const std::size_t row = images.first + image, grain = images.grain[image];
  p.view[row] = p.view[grain];
  p.view[row].position += images.shift[image];
  if constexpr (domain::IsSheared<Domain>) {
    p.view[row].position.x += images.level[image] * (domain.offset() - images.offset);
    p.view[row].velocity.x += images.level[image] * domain.slip();
  }
  std::copy_n(p.pose_of(grain), p.pose_size, p.pose_of(row));
}

/// Makes the rows of images: positions as they are now, and what never changes.
template <class GrainColumns>
void make_rows(GrainColumns& p, const ImageRows& images) {
  p.add_rows(images.grain.size());
  for (std::size_t k = 0; k < images.grain.size(); ++k) {
    const std::size_t row = images.first + k, grain = images.grain[k];
    p.position.set(row, p.position[grain] + images.shift[k]);
    p.species[row] = p.species[grain];
    p.id[row] = p.id[grain];
  }
}

/// The same in a sheared cell: along z an image is first shifted with its cell, then it has images along x and y.
template <class GrainColumns, domain::IsSheared Domain>
void find_images(ImageRows& images, const GrainColumns& p, const Domain& domain, double reach) {
  images = {};
  images.grains = static_cast<std::uint32_t>(p.count);
  images.first = static_cast<std::uint32_t>(p.chunks() * chunk_size);
  images.offset = domain.offset();
  const auto& period = domain.period();
  for (std::size_t i = 0; i < p.count; ++i) {
    const Vector3<double> x = p.position[i];
    for (const int level : {0, 1, -1}) {
      const double from_border = level > 0 ? x.z - domain.low(2) : domain.low(2) + period[2] - x.z;
      if (level != 0 && !(from_border < reach)) continue;
      const Vector3<double> up = level == 0 ? Vector3<double>{0, 0, 0} : domain.shift_to(x, level);
      const double place[] = {x.x + up.x, x.y};
      double to[2] = {0, 0};
      for (std::size_t k = 0; k < 2; ++k) {
        if (period[k] == 0.0) continue;
        if (place[k] - domain.low(k) < reach) to[k] = period[k];
        else if (domain.low(k) + period[k] - place[k] < reach) to[k] = -period[k];
      }
      for (unsigned axes = level == 0 ? 1 : 0; axes < 4; ++axes) {
        if ((axes & 1 && to[0] == 0.0) || (axes & 2 && to[1] == 0.0)) continue;
        images.grain.push_back(static_cast<std::uint32_t>(i));
        images.shift.push_back({up.x + (axes & 1 ? to[0] : 0.0), axes & 2 ? to[1] : 0.0, up.z});
        images.level.push_back(level);
      }
    }
  }
}

/// Lists the images of all grains within `reach` (m) of a border; positions are within the cell.
template <class GrainColumns, class Domain>
void find_images(ImageRows& images, const GrainColumns& p, const Domain& domain, double reach) {
  images.grains = static_cast<std::uint32_t>(p.count);
  images.first = static_cast<std::uint32_t>(p.chunks() * chunk_size);
  images.grain.clear();
  images.shift.clear();
  const auto& period = domain.period();
  for (std::size_t i = 0; i < p.count; ++i) {
    const Vector3<double> x = p.position[i];
    const double place[] = {x.x, x.y, x.z};
    // Along each axis a grain has an image if it is near a border; those of several axes combine.
    double to[3] = {0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      if (period[k] == 0.0) continue;
      if (place[k] - domain.low(k) < reach) to[k] = period[k];
      else if (domain.low(k) + period[k] - place[k] < reach) to[k] = -period[k];
    }
    for (unsigned axes = 1; axes < 8; ++axes) {
      const Vector3<double> shift = {axes & 1 ? to[0] : 0.0, axes & 2 ? to[1] : 0.0, axes & 4 ? to[2] : 0.0};
      if ((axes & 1 && to[0] == 0.0) || (axes & 2 && to[1] == 0.0) || (axes & 4 && to[2] == 0.0)) continue;
      images.grain.push_back(static_cast<std::uint32_t>(i));
      images.shift.push_back(shift);
    }
  }
}

}  // namespace dem::grain
