#pragma once

#include <dem/core/aligned.hpp>
#include <dem/core/ids.hpp>
#include <dem/grain/broadphase/uniform_grid.hpp>
#include <dem/math/vector.hpp>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace dem::soil {

/// How each grain (in the order of World::grains) is held by the others.
struct Coordination {
  std::vector<std::int32_t> neighbours;  ///< grains that touch it
  std::vector<std::int32_t> contacts;    ///< points at which they do

  /// Mean number of grains that touch a grain.
  double mean() const {
    const double sum = std::accumulate(neighbours.begin(), neighbours.end(), 0.0);
    return neighbours.empty() ? 0.0 : sum / static_cast<double>(neighbours.size());
  }
};

/// Finds who touches whom at the grains' present places. A search of its own, for now and then.
template <class World>
Coordination coordination(const World& world) {
  using Shape = typename World::Shape;
  const std::vector<GrainId> grains = world.grains();
  const std::size_t n = grains.size();
  Coordination result{std::vector<std::int32_t>(n, 0), std::vector<std::int32_t>(n, 0)};
  std::vector<double> x(n), y(n), z(n), reach(n);
  std::vector<const Shape*> shapes(n);
  AlignedVector<double> pose(n * Shape::pose_size + 1);
  double largest = 0.0;
  const auto shape_of = [&](std::size_t i) -> const Shape& { return *shapes[i]; };
  for (std::size_t i = 0; i < n; ++i) {
    shapes[i] = &world.species(world.species_of(grains[i])).shape;
    reach[i] = shape_of(i).bounding_radius();
    const Vec3 p = world.position(grains[i]);
    x[i] = p.x();
    y[i] = p.y();
    z[i] = p.z();
    largest = std::max(largest, reach[i]);
    if constexpr (Shape::pose_size > 0) {
      shape_of(i).orient(from_eigen(world.rotation(grains[i])), &pose[i * Shape::pose_size]);
    }
  }
  if (n == 0) return result;
  std::vector<std::size_t> image_of;  // in a periodic world, grains have images behind the rest
  if constexpr (World::Model::Domain::has_images) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 at(x[i], y[i], z[i]);
      world.state().domain.for_each_image(at, [&](const Vec3& image) {
        if (image == at) return;
        image_of.push_back(i);
        x.push_back(image.x()), y.push_back(image.y()), z.push_back(image.z());
      });
    }
  }
  broadphase::UniformGrid grid;
  grid.build(broadphase::Positions{x.data(), y.data(), z.data(), x.size()}, 2.0 * largest);
  auto finder = grid.finder();
  for (std::size_t i = 0; i < n; ++i) {
    finder.for_each_candidate(i, [&](std::size_t row) {
      const std::size_t j = row < n ? row : image_of[row - n];
      if (j <= i) return;
      const Vector3<double> apart = {x[row] - x[i], y[row] - y[i], z[row] - z[i]};
      if (dot(apart, apart) > (reach[i] + reach[j]) * (reach[i] + reach[j])) return;
      std::int32_t points = 0;
      Shape::collide(shape_of(i), &pose[i * Shape::pose_size], shape_of(j), &pose[j * Shape::pose_size], apart,
                     [&](std::uint32_t, const auto&) { ++points; });
      if (points == 0) return;
      for (const std::size_t k : {i, j}) {
        ++result.neighbours[k];
        result.contacts[k] += points;
      }
    });
  }
  return result;
}

}  // namespace dem::soil
