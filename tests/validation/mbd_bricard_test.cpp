// Bricard's mechanism (Gonzalez et al., Multibody Syst. Dyn. 16 (2006) 313): five rods and six hinges, which Gruebler
// counts as immobile (-1 freedoms), but which moves. Redundant constraints are no trouble to a penalty method: this
// shows it.

#include <dem/integrator/predictor_corrector.hpp>
#include <dem/mbd/mbd.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "catch.hpp"

using namespace dem;
using namespace dem::mbd;

TEST_CASE("Bricard's overconstrained mechanism moves and keeps its energy for 10 s") {
  Machine<integrator::PredictorCorrector> m;
  m.gravity = {0, -9.81, 0};
  const std::array<Vec3, 6> hinge = {Vec3(0, 0, 0),  Vec3(1, 0, 0),  Vec3(1, -1, 0),
                                     Vec3(1, -1, 1), Vec3(0, -1, 1), Vec3(0, 0, 1)};
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const std::array<Vec3, 6> axis = {y, z, x, y, z, x};
  BodyId last = m.ground();
  for (std::size_t k = 0; k < 5; ++k) {
    const Vec3 size = (hinge[k + 1] - hinge[k]).cwiseAbs().cwiseMax(Vec3::Constant(0.1));
    const BodyId rod =
        m.add_body(box_body("rod " + std::to_string(k), size, 100.0).at(0.5 * (hinge[k] + hinge[k + 1])));
    m.add_joint(revolute("hinge " + std::to_string(k), last, rod, hinge[k], axis[k]));
    last = rod;
  }
  const JointId closing = m.add_joint(revolute("hinge 5", last, m.ground(), hinge[5], axis[5]));
  const auto energy = [&] { return energy_of(m.parts(), m.gravity).sum(); };
  const double start = energy();
  double worst = 0.0, travel = 0.0, gap = 0.0, most = 0.0;
  REQUIRE(m.run(10.0, 1e-5, [&] {
    worst = std::max(worst, std::abs(energy() - start));
    travel = std::max(travel, std::abs(m.coordinate(closing)));
    gap = std::max(gap, m.violation(closing).displacement);
    most = std::max(most, energy_of(m.parts(), m.gravity).kinetic);
  }));
  WARN("Bricard: largest energy error " << worst << " J, kinetic energy up to " << most << " J, hinge turned by up to "
                                        << travel << " rad, opened by up to " << gap << " m");
  CHECK(travel > 0.5);
  CHECK(most > 4.0);
  // 1.9e-4 J was measured, and 8 times that at twice the step, where the derived stiffness is a quarter.
  CHECK(worst < 5e-4);
  CHECK(gap < 1e-6);
}
