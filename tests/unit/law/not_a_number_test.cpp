#include "catch.hpp"

#include <dem/grain/contact_wrench.hpp>
#include <dem/law/cohesion/jkr.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/hysteretic.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/law/normal/penalty.hpp>
#include <dem/world/model.hpp>

#include <cmath>
#include <limits>

namespace not_a_number_test {

using dem::Pack;

// An overlap that is not a number comes from a shape of the user's own. Were it cut off as a pull is, the contact would
// be silently without force; as a NaN it reaches the grain, and the report of the step.

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

template <class T>
bool is_no_number(const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    return std::isnan(x);
  } else {
    bool all = true;
    for (int k = 0; k < dem::pack_width; ++k) all &= std::isnan(dem::lane(x, k));
    return all;
  }
}

/// The force of law L with packs or doubles as numbers; its constants c and its state have the given values.
template <class L, class T, class... C>
T force(T overlap, T approach, C... c) {
  const typename L::template Parameters<T> p = {T(c)...};
  typename L::template History<T> h = {};
  return L::force(p, dem::contact::NormalState<T>{overlap, approach, T(1e-3), T(1e-5), T(1e-6)}, h);
}

template <class L, class... C>
void check_keeps(C... c) {
  CHECK(is_no_number(force<L, double>(no_number, 0.1, c...)));
  CHECK(is_no_number(force<L, Pack>(Pack(no_number), Pack(0.1), c...)));
  CHECK(force<L, double>(1e-5, 0.0, c...) > 0.0);
}
/// Also where it is the speed that is no number: of laws with a damper.
template <class L, class... C>
void check_keeps_speed(C... c) {
  check_keeps<L>(c...);
  CHECK(is_no_number(force<L, double>(1e-5, no_number, c...)));
  CHECK(is_no_number(force<L, Pack>(Pack(1e-5), Pack(no_number), c...)));
}

template <class Law, class Attraction>
struct With : dem::Model {
  using Normal = Law;
  using Friction = dem::friction::None;
  using Cohesion = Attraction;
};

}  // namespace

TEST_CASE("the second argument of min and max keeps a NaN, in packs as well") {
  CHECK(is_no_number(dem::max(0.0, no_number)));
  CHECK(is_no_number(dem::min(0.0, no_number)));
  CHECK(is_no_number(dem::max(Pack(0.0), Pack(no_number))));
  CHECK(is_no_number(dem::min(Pack(0.0), Pack(no_number))));
}

TEST_CASE("normal laws keep a NaN, in packs as well") {
  using namespace dem::contact;
  check_keeps_speed<Penalty>(2000.0, 0.015, 0.05);
  check_keeps_speed<LinearSpringDashpot>(2000.0, 0.1, 0.0);
  check_keeps_speed<LinearSpringDashpot>(2000.0, 0.1, 1.0);
  check_keeps_speed<Hertz>(1e8, 0.1, 0.0);
  check_keeps<Hysteretic>(1000.0, 4000.0);
}

TEST_CASE("a cohesion law that acts at a distance does not take a NaN for a gap") {
  using dem::contact::NormalState;
  const NormalState<double> state = {no_number, 0.0, 1e-3, 1e-5, 1e-6};
  using Wet = With<dem::contact::LinearSpringDashpot, dem::cohesion::LiquidBridge>;
  dem::ContactHistory<Wet, double> wet = {};
  const dem::ContactParameters<Wet> bridge = {{1000, 0, 0}, {}, {}, dem::cohesion::LiquidBridge::of(0.07, 0.0, 1e-12)};
  CHECK(std::isnan(dem::grain::normal_force<Wet>(state, bridge, wet).repulsion));
  using Soft = With<dem::contact::Hertz, dem::cohesion::JKR>;
  dem::ContactHistory<Soft, double> soft = {};
  const dem::ContactParameters<Soft> jkr = {{1e8, 0, 0}, {}, {}, {0.1, 1e8}};
  CHECK(std::isnan(dem::grain::normal_force<Soft>(state, jkr, soft).repulsion));
}

}  // namespace not_a_number_test
