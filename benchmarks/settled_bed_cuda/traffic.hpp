#pragma once

// The fewest bytes that a step moves between a GPU and its memory: each kernel reads what it needs once and writes what
// it finds once, however often caches are asked.

#include <dem/flat/contact_result.hpp>
#include <dem/flat/pair_kernels.hpp>
#include <dem/world/state.hpp>

namespace bench {

/// Pairs in the neighbour list.
template <class World>
std::size_t candidates(const World& world) {
  std::size_t sum = 0;
  for (const auto& chunk : world.state().chunks) sum += chunk.candidate.size();
  return sum;
}

/// Of an integrator that evaluates forces once a step. Contacts at surfaces are few and left out.
template <class Model>
double bytes_of_a_step(const dem::World<Model>& world) {
  using Shape = typename Model::Shape;
  using View = dem::flat::GrainsView<Model>;
  constexpr double number = sizeof(double), index = sizeof(std::uint32_t), bits = sizeof(dem::flat::ContactBits<Shape>),
                   view = sizeof(dem::PartnerView), pose = Shape::pose_size * number,
                   history = dem::history_size<Model> * number, result = sizeof(dem::flat::ContactResult);
  const double grains = double(world.grain_count()), pairs = double(candidates(world));
  double contacts = 0.0;
  for (const auto& chunk : world.state().chunks) contacts += chunk.pair_contacts.committed();
  const double find = pairs * (2 * index + bits) + grains * (view + pose);
  const double number_them = pairs * (bits + index) + pairs * (bits + index) + contacts * (index + 1);
  const double laws = contacts * (3 * index + 1 + bits + index + 2 * history + result) + grains * (view + pose + index);
  // Results are read by both partners. Motion, with the rotation of grains that have one, is read and written.
  constexpr double turns = Shape::has_orientation ? 9 : 0;
  constexpr double columns = 9 + turns + View::memory_size;
  const double move = contacts * 2 * result + pairs * 3 * index + grains * (4 * index) +
                      grains * (number * (2 * columns + 6 + 3) + view + pose);
  const double surfaces = grains * (view + 4 * index);
  return find + number_them + laws + move + surfaces;
}

}  // namespace bench
