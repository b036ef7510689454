#include <dem/pipeline/contact_evaluator.hpp>
#include <dem/shape/polyhedron.hpp>
#include <dem/shape/sphere.hpp>
#include <dem/world/model.hpp>

#include "catch.hpp"

using namespace dem;
using namespace dem::pipeline;

namespace {

/// Slips (along x, m) of three contacts after a step in which nothing moves: a new point of pair 0, whose old points
/// had slipped by 1 and 3 micrometres; the old point of pair 1, 8 micrometres; a point of pair 2, which did not touch
/// before.
template <class Shape>
std::array<double, 3> slips() {
  const std::vector<ContactParameters<Model>> table = {{{1000.0, 0.0, 1.0}, {0.5, 1000.0, 0.0, 1.0}, {}, {}}};
  ContactMemories<history_size<Model>> memories;
  memories.last.reserve(16);
  memories.last.count = 3;
  memories.last.key = {5, 9, std::uint64_t{1} << 32 | 2};
  memories.last.history[0] = {1e-6, 3e-6, 8e-6};
  const std::vector<Hit> hits = {
      {7, 0, 1, 0}, {std::uint64_t{1} << 32 | 2, 0, 2, 0}, {std::uint64_t{2} << 32 | 1, 0, 3, 0}};
  // Pressed by 1 mm: 1 N, so that 0.5 N limits springs of at most 8e-3 N.
  const contact::PointTouch<double> touch = {{0, 0, 1}, 1e-3, {0, 0, 1e-3}, 1e-3, 1.0};
  const PartnerView still = {{0, 0, 0}, 1e-3, {0, 0, 0}, 1.0, {0, 0, 0}};
  ContactForces forces;
  ContactEvaluator<Model, contact::PointTouch, Shape> evaluator(table, 1e-6);
  const auto view = [&](std::size_t) -> const PartnerView& { return still; };
  evaluator.run(
      hits, memories, forces, [&](std::size_t) { return touch; }, view, view);
  const auto& now = memories.now.history[0];
  return {now[0], now[1], now[2]};
}

}  // namespace

TEST_CASE("a new point of a patch remembers the mean of the others, a new contact of any other shape nothing") {
  using Catch::Approx;
  const auto patch = slips<shape::Polyhedron>(), single = slips<shape::Sphere>();
  CHECK(patch[0] == Approx(2e-6).epsilon(1e-14));
  CHECK(single[0] == 0.0);
  for (const auto& s : {patch, single}) {
    CHECK(s[1] == Approx(8e-6).epsilon(1e-14));
    CHECK(s[2] == 0.0);
  }
}
