#include "catch.hpp"
#include "random.hpp"

#include <dem/coupling/follow_turns.hpp>

using dem::Vec3;
using dem::grain::Hit;
using Histories = dem::ContactHistories<1>;

namespace {

std::uint64_t key(std::uint64_t family, const Vec3& direction) {
  return family << dem::surface::direction_bits | dem::surface::direction_code(dem::from_eigen(direction.normalized()));
}
/// Contacts of a step that remember a number each.
struct Step {
  std::vector<std::pair<std::uint64_t, double>> contacts;

  Histories histories() const {
    auto sorted = contacts;
    std::sort(sorted.begin(), sorted.end());
    Histories m;
    m.reserve(16);
    for (const auto& [k, value] : sorted) {
      m.key[static_cast<std::size_t>(m.count)] = k;
      m.history[0][static_cast<std::size_t>(m.count++)] = value;
    }
    return m;
  }
};
/// What the contacts with these keys remember of the step before; -1: nothing.
std::vector<double> recalled(const Step& before, std::vector<std::uint64_t> keys, bool have_directions = true) {
  Histories m = before.histories();
  auto sorted = keys;
  std::sort(sorted.begin(), sorted.end());
  std::vector<Hit> hits;
  for (const std::uint64_t k : sorted) hits.push_back({k, 0, 0, 0});
  dem::coupling::follow_turns(std::span<const Hit>(hits), m, [&](std::uint64_t) { return have_directions; });
  CHECK(std::is_sorted(m.key.begin(), m.key.begin() + m.count));
  std::vector<double> values;
  for (const std::uint64_t k : keys) {
    const auto end = m.key.begin() + m.count, at = std::find(m.key.begin(), end, k);
    values.push_back(at == end ? -1.0 : m.history[0][static_cast<std::size_t>(at - m.key.begin())]);
  }
  return values;
}
using Values = std::vector<double>;

const Vec3 floor_(0.02, 0.01, -1), tilted(0.5, 0.01, -1), wall(-1, 0.03, 0.02), ceiling(0.02, 0.01, 1);

}  // namespace

TEST_CASE("a contact that turns goes on remembering, all the way round") {
  Step now = {{{key(5, Vec3(0, 0, -1)), 7.0}}};
  for (int k = 1; k <= 400; ++k) {
    const double angle = 2 * M_PI * k / 400;
    const std::uint64_t turned = key(5, Vec3(std::sin(angle), 0.2, -std::cos(angle)));
    REQUIRE(recalled(now, {turned}) == Values{7.0});
    now.contacts[0].first = turned;
  }
}

TEST_CASE("of two contacts of a group either may vanish, come back, or turn") {
  const Step both = {{{key(5, floor_), 1.0}, {key(5, wall), 2.0}, {key(6, floor_), 3.0}}};
  CHECK(recalled(both, {key(5, floor_), key(5, wall)}) == Values{1.0, 2.0});
  CHECK(recalled(both, {key(5, floor_)}) == Values{1.0});
  CHECK(recalled(both, {key(5, wall), key(6, floor_)}) == Values{2.0, 3.0});
  CHECK(recalled(both, {key(5, tilted), key(5, wall)}) == Values{1.0, 2.0});
  CHECK(recalled(both, {key(5, tilted)}) == Values{1.0});
  const Step floor_only = {{{key(5, floor_), 1.0}}};
  CHECK(recalled(floor_only, {key(5, floor_), key(5, wall)}) == Values{1.0, -1.0});
  CHECK(recalled(floor_only, {key(5, tilted), key(5, wall)}) == Values{1.0, -1.0});
  // What points more than 60 degrees away is another contact, and other groups are none of its business.
  CHECK(recalled(floor_only, {key(5, wall)}) == Values{-1.0});
  CHECK(recalled(floor_only, {key(5, ceiling)}) == Values{-1.0});
  CHECK(recalled(floor_only, {key(4, tilted), key(6, tilted)}) == Values{-1.0, -1.0});
  CHECK(recalled({}, {key(5, floor_)}) == Values{-1.0});
  CHECK(recalled(floor_only, {}) == Values{});
  // Keys that do not end in a direction are left alone.
  CHECK(recalled(floor_only, {key(5, tilted)}, false) == Values{-1.0});
}

TEST_CASE("among many contacts each keeps its own history when all turn a little") {
  Random random(9);
  for (int trial = 0; trial < 200; ++trial) {
    const dem::Mat3 turn = random.rotation();
    const dem::Mat3 little = Eigen::AngleAxisd(0.1, random.vector(1.0).normalized()).toRotationMatrix();
    Step before;
    std::vector<std::uint64_t> keys;
    Values expected;
    for (std::uint64_t family = 3; family < 6; ++family) {
      for (const Vec3& n : {floor_, wall, ceiling}) {
        before.contacts.emplace_back(key(family, turn * n), static_cast<double>(expected.size()));
        keys.push_back(key(family, little * turn * n));
        expected.push_back(static_cast<double>(expected.size()));
      }
    }
    CHECK(recalled(before, keys) == expected);
  }
}
